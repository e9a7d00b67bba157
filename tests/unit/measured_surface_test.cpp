// Several profiles as one surface: averaged moments and their spread.
#include "core/surface/measured_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace tribodyn {
namespace {

MeasuredProfile profile(FlankMember member, ProfileDirection direction, double factor) {
  return {member, direction, {1e-14 * factor, 1e-3 * factor, 4e8 * factor}};
}

TEST(MeasuredSurface, SixProfilesAreTheSumOfTheMeansOfBothMembers) {
  std::vector<MeasuredProfile> six;
  SpectralMoments sum{};
  for (const FlankMember member : {FlankMember::kPinion, FlankMember::kGear}) {
    for (const double factor : {0.8, 1.0, 1.5}) {
      six.push_back(
          profile(member, ProfileDirection::kAny, factor * (member == FlankMember::kGear ? 2 : 1)));
      sum.m0 += six.back().moments.m0 / 3;
      sum.m2 += six.back().moments.m2 / 3;
      sum.m4 += six.back().moments.m4 / 3;
    }
  }
  const Roughness roughness = roughness_of_profiles(six, {});
  const Roughness wanted = greenwood_tripp_roughness(sum);
  EXPECT_NEAR(roughness.asperity_density / wanted.asperity_density, 1, 1e-14);
  EXPECT_NEAR(roughness.asperity_radius / wanted.asperity_radius, 1, 1e-14);
  EXPECT_NEAR(roughness.composite_rms_height / wanted.composite_rms_height, 1, 1e-14);
}

TEST(MeasuredSurface, TheUncertaintyIsTheStandardErrorOfTheMeanWhereAParameterIsLinear) {
  // All moments of a profile have one factor f: eta_G does not change, beta_G goes with
  // mean(f)^-1/2 and sigma_G with mean(f)^1/2.
  std::vector<MeasuredProfile> profiles;
  const std::vector<double> factors{0.97, 1.01, 0.99, 1.03};
  for (const double factor : factors) {
    profiles.push_back(profile(FlankMember::kBoth, ProfileDirection::kAny, factor));
  }
  double variance = 0;
  for (const double factor : factors) variance += (factor - 1) * (factor - 1) / 3;
  const double error = std::sqrt(variance / 4);
  const Roughness roughness = roughness_of_profiles(profiles, {});
  const auto uncertainty = roughness_uncertainty(profiles, {});
  ASSERT_TRUE(uncertainty);
  EXPECT_NEAR(uncertainty->asperity_density / roughness.asperity_density, 0, 1e-12);
  EXPECT_NEAR(uncertainty->asperity_radius / roughness.asperity_radius / (0.5 * error), 1, 0.01);
  EXPECT_NEAR(uncertainty->composite_rms_height / roughness.composite_rms_height / (0.5 * error), 1,
              0.01);
}

TEST(MeasuredSurface, TheUncertaintyIsTheScatterOfRepeatedMeasurements) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  constexpr int kExperiments = 2000;
  double sum = 0, squares = 0, stated = 0;
  for (int n = 0; n < kExperiments; ++n) {
    std::vector<MeasuredProfile> six;
    for (const FlankMember member : {FlankMember::kPinion, FlankMember::kGear}) {
      for (int i = 0; i < 3; ++i) {
        six.push_back(profile(member, ProfileDirection::kAxial, 1 + 0.1 * normal(engine)));
      }
    }
    const double height = roughness_of_profiles(six, {}).composite_rms_height;
    sum += height / kExperiments;
    squares += height * height / kExperiments;
    stated += std::pow(roughness_uncertainty(six, {})->composite_rms_height, 2) / kExperiments;
  }
  EXPECT_NEAR(stated / (squares - sum * sum), 1, 0.1);
}

TEST(MeasuredSurface, AFlankMeasuredOnceHasNoKnownSpread) {
  std::vector<MeasuredProfile> profiles{profile(FlankMember::kPinion, ProfileDirection::kAny, 1),
                                        profile(FlankMember::kPinion, ProfileDirection::kAny, 1.1),
                                        profile(FlankMember::kGear, ProfileDirection::kAny, 1)};
  EXPECT_FALSE(roughness_uncertainty(profiles, {}));
  profiles.push_back(profile(FlankMember::kGear, ProfileDirection::kAny, 1.2));
  EXPECT_TRUE(roughness_uncertainty(profiles, {}));
}

}  // namespace
}  // namespace tribodyn
