#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "core/surface/spectral_moments.h"

namespace tribodyn {
namespace {

constexpr double kAmplitude = 0.6e-6;
constexpr double kWavelength = 80e-6;
constexpr double kWaveNumber = 2 * std::numbers::pi / kWavelength;

// `count` samples of A sin(k x + phase), `per_wave` to a wavelength.
std::vector<double> sine(int count, int per_wave, double phase = 0.3) {
  std::vector<double> heights;
  for (int i = 0; i < count; ++i) {
    heights.push_back(kAmplitude * std::sin(2 * std::numbers::pi * i / per_wave + phase));
  }
  return heights;
}

std::string reason(const std::vector<double>& heights, double spacing) {
  try {
    spectral_moments(heights, spacing);
  } catch (const Refusal& refusal) {
    return refusal.reason() + ": " + refusal.what();
  }
  return "none";
}

TEST(SpectralMoments, MatchTheDiscreteTransferOfASine) {
  for (const int per_wave : {5, 8, 12, 50, 1000}) {
    const double spacing = kWavelength / per_wave;
    // whole waves for m0; whole waves of interior points, so two samples more, for m2 and m4
    const SpectralMoments whole = spectral_moments(sine(20 * per_wave, per_wave), spacing);
    EXPECT_NEAR(whole.m0 / (kAmplitude * kAmplitude / 2), 1, 1e-12);
    const std::vector<double> interior = sine(20 * per_wave + 2, per_wave);
    const double q = 2 * std::numbers::pi / per_wave;
    const double slope = kAmplitude * kWaveNumber * std::sin(q) / q;
    const double curvature = kAmplitude * std::pow(kWaveNumber * std::sin(q / 2) / (q / 2), 2);
    const SpectralMoments moments = spectral_moments(interior, spacing);
    EXPECT_NEAR(moments.m2 / (slope * slope / 2), 1, 1e-11) << per_wave;
    EXPECT_NEAR(moments.m4 / (curvature * curvature / 2), 1, 1e-9) << per_wave;
  }
}

TEST(SpectralMoments, ConvergeAtSecondOrder) {
  const double m2 = std::pow(kAmplitude * kWaveNumber, 2) / 2;
  const double m4 = std::pow(kAmplitude * kWaveNumber * kWaveNumber, 2) / 2;
  const auto error = [&](int per_wave) {
    const SpectralMoments moments =
        spectral_moments(sine(30 * per_wave + 2, per_wave), kWavelength / per_wave);
    return std::pair{std::abs(moments.m2 / m2 - 1), std::abs(moments.m4 / m4 - 1)};
  };
  const auto coarse = error(40);
  const auto fine = error(80);
  EXPECT_NEAR(std::log2(coarse.first / fine.first), 2, 0.01);
  EXPECT_NEAR(std::log2(coarse.second / fine.second), 2, 0.01);
  EXPECT_LT(error(2000).first, 1e-5);
  EXPECT_LT(error(2000).second, 1e-5);
}

TEST(SpectralMoments, AreIndependentOfTheDatum) {
  std::vector<double> heights = sine(402, 40);
  const double spacing = kWavelength / 40;
  const SpectralMoments reference = spectral_moments(heights, spacing);
  for (double& z : heights) z += 1e-3;
  const SpectralMoments shifted = spectral_moments(heights, spacing);
  EXPECT_NEAR(shifted.m0 / reference.m0, 1, 1e-9);
  EXPECT_NEAR(shifted.m2 / reference.m2, 1, 1e-9);
  EXPECT_NEAR(shifted.m4 / reference.m4, 1, 1e-7);
}

TEST(SpectralMoments, AreIndependentOfTheTiltWhenDetrended) {
  std::vector<double> heights = sine(402, 40);
  const double spacing = kWavelength / 40;
  const SpectralMoments reference =
      spectral_moments(heights, spacing, Levelling::kLeastSquaresLine);
  constexpr double kTilt = 0.01;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    heights[i] += kTilt * spacing * static_cast<double>(i);
  }
  const SpectralMoments tilted = spectral_moments(heights, spacing, Levelling::kLeastSquaresLine);
  EXPECT_NEAR(tilted.m0 / reference.m0, 1, 1e-9);
  EXPECT_NEAR(tilted.m2 / reference.m2, 1, 1e-9);
  EXPECT_NEAR(tilted.m4 / reference.m4, 1, 1e-9);
  // Without levelling the tilt counts.
  EXPECT_GT(spectral_moments(heights, spacing).m0, 2 * reference.m0);
}

TEST(SpectralMoments, AreZeroForADetrendedStraightLine) {
  std::vector<double> heights;
  for (int i = 0; i < 11; ++i) heights.push_back(0.25 * i);
  const SpectralMoments moments = spectral_moments(heights, 0.5, Levelling::kLeastSquaresLine);
  EXPECT_NEAR(moments.m0, 0, 1e-30);
  EXPECT_NEAR(moments.m2, 0, 1e-30);
  EXPECT_NEAR(moments.m4, 0, 1e-30);
  EXPECT_NEAR(spectral_moments(heights, 0.5).m2, 0.25, 1e-15);
}

TEST(SpectralMoments, AreExactForAParabola) {
  // z = x^2: both central differences are exact, slope 2 x and curvature 2
  std::vector<double> heights;
  for (int i = -5; i <= 5; ++i) heights.push_back(i * i);
  const SpectralMoments moments = spectral_moments(heights, 1);
  EXPECT_NEAR(moments.m4, 4, 1e-14);
  EXPECT_NEAR(moments.m2, 4 * 60.0 / 9, 1e-13);  // mean of 4 i^2 over i = -4..4
  EXPECT_NEAR(moments.m0, 1958.0 / 11 - 100, 1e-12);
}

TEST(SpectralMoments, ScaleWithHeightAndSpacing) {
  const std::vector<double> heights = sine(402, 40);
  std::vector<double> larger = heights;
  for (double& z : larger) z *= 3;
  const SpectralMoments one = spectral_moments(heights, 1e-6);
  const SpectralMoments higher = spectral_moments(larger, 1e-6);
  EXPECT_NEAR(higher.m0 / one.m0, 9, 1e-12);
  EXPECT_NEAR(higher.m2 / one.m2, 9, 1e-12);
  EXPECT_NEAR(higher.m4 / one.m4, 9, 1e-12);
  const SpectralMoments longer = spectral_moments(heights, 2e-6);
  EXPECT_NEAR(longer.m0 / one.m0, 1, 1e-15);
  EXPECT_NEAR(longer.m2 / one.m2, 1.0 / 4, 1e-15);
  EXPECT_NEAR(longer.m4 / one.m4, 1.0 / 16, 1e-15);
}

TEST(SpectralMoments, RefuseAnUnusableProfile) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(reason({0, 1, 0, 1, 0}, 1e-6), "none");
  EXPECT_NE(reason({}, 1e-6).find("0 heights"), std::string::npos);
  EXPECT_NE(reason({0, 1, 0, 1}, 1e-6).find("4 heights"), std::string::npos);
  for (const double spacing : {0.0, -1e-6, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(reason({0, 1, 0, 1, 0}, spacing).find("spacing"), std::string::npos);
  }
  EXPECT_NE(reason({1e200, -1e200, 1e200, -1e200, 0}, 1e-6).find("not finite"), std::string::npos);
}

TEST(SpectralMoments, NameEveryFault) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string sentence = reason({0, 1, nan, nan}, -1);
  EXPECT_EQ(sentence.find("PROFILE_UNUSABLE"), 0u);
  EXPECT_NE(sentence.find("4 heights"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("not finite: 2, the first at index 2"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("spacing is -1 m"), std::string::npos) << sentence;
}

TEST(WaveLength, IsThatOfASine) {
  for (const int per_wave : {5, 8, 50}) {
    const double spacing = kWavelength / per_wave;
    const SpectralMoments moments = spectral_moments(sine(20 * per_wave + 2, per_wave), spacing);
    EXPECT_NEAR(wave_length_in_spacings(moments, spacing) / per_wave, 1, 1e-9);
  }
}

TEST(WaveLength, TellsFilteredNoiseFromWhiteNoise) {
  constexpr double kSampling = 0.5e-6;
  std::mt19937 random(1);
  std::normal_distribution<double> height(0, 0.3e-6);
  std::vector<double> white(40'000);
  for (double& z : white) z = height(random);
  EXPECT_NEAR(wave_length_in_spacings(spectral_moments(white, kSampling), kSampling), 3, 0.05);
  // ISO 16610-21 with lambda_s of five spacings.
  constexpr double kCutOff = 5, kAlpha = 0.4697;
  std::vector<double> filtered;
  for (std::size_t i = 5; i + 5 < white.size(); ++i) {
    double sum = 0;
    for (int k = -5; k <= 5; ++k) {
      const double x = k / (kAlpha * kCutOff);
      sum += std::exp(-std::numbers::pi * x * x) / (kAlpha * kCutOff) *
             white[i + static_cast<std::size_t>(k + 5) - 5];
    }
    filtered.push_back(sum);
  }
  const double waves = wave_length_in_spacings(spectral_moments(filtered, kSampling), kSampling);
  EXPECT_NEAR(waves, 5.3, 0.1);
  EXPECT_GT(waves, kLeastSpacingsPerWave);
}

TEST(EquivalentIsotropicMoments, LeaveAnIsotropicSurfaceUnchanged) {
  const SpectralMoments surface{1.6e-13, 0.02, 3e8};
  const SpectralMoments same = equivalent_isotropic_moments(surface, surface, {});
  EXPECT_DOUBLE_EQ(same.m0, surface.m0);
  EXPECT_DOUBLE_EQ(same.m2, surface.m2);
  EXPECT_DOUBLE_EQ(same.m4, surface.m4);
}

TEST(EquivalentIsotropicMoments, AreTheMeansOfEq46AndItsPrintedForm) {
  const SpectralMoments axial{1, 4, 16};
  const SpectralMoments radial{3, 9, 25};
  const SpectralMoments mean = equivalent_isotropic_moments(axial, radial, {});
  EXPECT_DOUBLE_EQ(mean.m0, 2);
  EXPECT_DOUBLE_EQ(mean.m2, 6);
  EXPECT_DOUBLE_EQ(mean.m4, 20);
  AsPublished printed;
  printed.eq46_square_root_of_sum = true;
  const SpectralMoments as_printed = equivalent_isotropic_moments(axial, radial, printed);
  EXPECT_DOUBLE_EQ(as_printed.m0, 2);
  EXPECT_DOUBLE_EQ(as_printed.m2, std::sqrt(13.0));
  EXPECT_DOUBLE_EQ(as_printed.m4, std::sqrt(41.0));
}

TEST(CompositeMoments, AreSums) {
  const SpectralMoments sum = composite_moments({1, 2, 3}, {10, 20, 30});
  EXPECT_EQ(sum.m0, 11);
  EXPECT_EQ(sum.m2, 22);
  EXPECT_EQ(sum.m4, 33);
}

TEST(GreenwoodTrippRoughness, SatisfiesEq48) {
  const SpectralMoments moments{0.16e-12, 0.02, 3e8};
  const Roughness roughness = greenwood_tripp_roughness(moments);
  EXPECT_DOUBLE_EQ(roughness.composite_rms_height, 0.4e-6);
  EXPECT_NEAR(roughness.asperity_radius * roughness.asperity_radius * moments.m4 / std::numbers::pi,
              0.375 * 0.375, 1e-15);
  EXPECT_NEAR(roughness.asperity_density * moments.m2 / moments.m4,
              1 / (6 * std::numbers::pi * std::sqrt(3.0)), 1e-16);
}

TEST(GreenwoodTrippRoughness, ScalesWithTheSurface) {
  // A surface s times as large in every direction: lengths times s, density over s^2.
  constexpr double kScale = 7;
  const SpectralMoments one{0.16e-12, 0.02, 3e8};
  const SpectralMoments scaled{one.m0 * kScale * kScale, one.m2, one.m4 / (kScale * kScale)};
  const Roughness a = greenwood_tripp_roughness(one);
  const Roughness b = greenwood_tripp_roughness(scaled);
  EXPECT_NEAR(b.composite_rms_height / a.composite_rms_height, kScale, 1e-14);
  EXPECT_NEAR(b.asperity_radius / a.asperity_radius, kScale, 1e-14);
  EXPECT_NEAR(b.asperity_density / a.asperity_density, 1 / (kScale * kScale), 1e-16);
}

TEST(GreenwoodTrippRoughness, RefusesASmoothSurface) {
  EXPECT_THROW(greenwood_tripp_roughness({0, 0.02, 3e8}), Refusal);
  EXPECT_THROW(greenwood_tripp_roughness({1e-13, 0, 3e8}), Refusal);
  EXPECT_THROW(greenwood_tripp_roughness({1e-13, 0.02, 0}), Refusal);
  EXPECT_THROW(greenwood_tripp_roughness({std::nan(""), 0.02, 3e8}), Refusal);
}

}  // namespace
}  // namespace tribodyn
