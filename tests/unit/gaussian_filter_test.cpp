#include "core/surface/gaussian_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/refusal_reason.h"

namespace tribodyn {
namespace {

constexpr double kSpacing = 0.5e-6;
constexpr int kSamples = 8001;

std::vector<double> sine(double wave_length) {
  std::vector<double> heights;
  for (int i = 0; i < kSamples; ++i) {
    heights.push_back(1e-6 * std::sin(2 * std::numbers::pi * i * kSpacing / wave_length));
  }
  return heights;
}

// Away from the ends, where weights lack heights.
double amplitude(const std::vector<double>& heights) {
  const auto margin = static_cast<std::ptrdiff_t>(heights.size() / 4);
  const auto [least, most] = std::minmax_element(heights.begin() + margin, heights.end() - margin);
  return (*most - *least) / 2;
}

TEST(GaussianFilter, PassesWavesAsTheStandardSays) {
  constexpr double kCutOff = 40e-6;
  for (const double ratio : {0.5, 1.0, 2.0, 5.0}) {  // wave length over cut-off
    const double passed = std::exp(-std::numbers::ln2 / (ratio * ratio));
    const std::vector<double> wave = sine(ratio * kCutOff);
    EXPECT_NEAR(amplitude(filtered_profile(wave, kSpacing, {kCutOff, 0})) / 1e-6, passed, 2e-3);
    EXPECT_NEAR(amplitude(filtered_profile(wave, kSpacing, {0, kCutOff})) / 1e-6, 1 - passed, 2e-3);
  }
}

TEST(GaussianFilter, LeavesOutHalfACutOffAtEachEnd) {
  const std::vector<double> wave = sine(100e-6);
  EXPECT_EQ(filtered_profile(wave, kSpacing, {}), wave);
  EXPECT_EQ(filtered_profile(wave, kSpacing, {2.5e-6, 0}).size(), kSamples - 4U);
  EXPECT_EQ(filtered_profile(wave, kSpacing, {2.5e-6, 800e-6}).size(), kSamples - 4U - 1600U);
}

TEST(GaussianFilter, KeepsAStraightLineAndTakesItOff) {
  std::vector<double> line;
  for (int i = 0; i < 500; ++i) line.push_back(1e-6 + 1e-9 * i);
  const std::vector<double> smooth = filtered_profile(line, kSpacing, {10e-6, 0});
  for (std::size_t i = 20; i + 20 < smooth.size(); ++i) {
    EXPECT_NEAR(smooth[i], line[i + 10], 1e-15);
  }
  const std::vector<double> rough = filtered_profile(line, kSpacing, {0, 10e-6});
  for (std::size_t i = 20; i + 20 < rough.size(); ++i) EXPECT_NEAR(rough[i], 0, 1e-15);
}

TEST(GaussianFilter, RefusesWhatCannotBeFiltered) {
  const std::vector<double> wave = sine(100e-6);
  const auto reason = [&](double shortest, double longest, double spacing = kSpacing) {
    return refusal_reason([&] { filtered_profile(wave, spacing, {shortest, longest}); });
  };
  EXPECT_EQ(reason(0.9e-6, 0), "PROFILE_FILTER") << "below two spacings";
  EXPECT_EQ(reason(0, 4.1e-3), "PROFILE_FILTER") << "longer than the profile";
  EXPECT_EQ(reason(3e-6, 2e-6), "PROFILE_FILTER");
  EXPECT_EQ(reason(-1, 0), "PROFILE_FILTER");
  EXPECT_EQ(reason(NAN, 0), "PROFILE_FILTER");
  EXPECT_EQ(reason(0, INFINITY), "PROFILE_FILTER");
  const std::vector<double> long_profile(300'000);
  EXPECT_EQ(refusal_reason([&] {
              filtered_profile(long_profile, 1e-7, {0, 8e-3});
            }),
            "PROFILE_FILTER")
      << "a minute of work";
}

}  // namespace
}  // namespace tribodyn
