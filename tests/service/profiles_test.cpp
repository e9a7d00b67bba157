// EvaluateProfiles: the surface of measured profiles by the sampling interval.
#include "server/application/profiles.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "core/surface/measured_surface.h"
#include "core/surface/spectral_moments.h"
#include "server/resources/imports/import_surface.h"
#include "server/simulation/profile_evaluation.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;

constexpr double kSpacing = 1e-6;  // [m]

std::string csv_of(const std::vector<double>& nanometres) {
  std::string out = "position_micrometres,height_nanometres\n";
  for (std::size_t i = 0; i < nanometres.size(); ++i) {
    out += fmt::format("{},{}\n", 1e6 * kSpacing * static_cast<double>(i), nanometres[i]);
  }
  return out;
}

/// A wave of `samples` sampling intervals length.
std::vector<double> profile_wave(double samples, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    out.push_back(300 * std::sin(2 * std::numbers::pi * i / samples));
  }
  return out;
}

/// Heights of a random walk that returns to its mean: a surface that is rough at all lengths.
std::vector<double> rough_heights(unsigned seed_number, int count) {
  std::mt19937 engine(seed_number);
  std::normal_distribution<double> normal;
  std::vector<double> out{0};
  while (static_cast<int>(out.size()) < count) {
    out.push_back(0.995 * out.back() + 30 * normal(engine));
  }
  return out;
}

/// Heel, middle and toe of both members along the tooth.
v1::EvaluateProfilesRequest six_profiles() {
  v1::EvaluateProfilesRequest out;
  unsigned number = 0;
  for (const v1::FlankMember member : {v1::FLANK_MEMBER_PINION, v1::FLANK_MEMBER_GEAR}) {
    for (int i = 0; i < 3; ++i) {
      v1::SurfaceProfile& profile = *out.add_profiles();
      profile.set_member(member);
      profile.set_direction(v1::PROFILE_DIRECTION_AXIAL);
      profile.set_csv(csv_of(rough_heights(++number, 2000)));
    }
  }
  return out;
}

v1::EvaluateProfilesResponse run_profiles(const v1::EvaluateProfilesRequest& request) {
  Violations violations;
  const auto out = evaluate_profiles(
      request, [] { return false; }, violations);
  if (!out) throw std::runtime_error(violations.front().description);
  return *out;
}

std::string profile_violations(const v1::EvaluateProfilesRequest& request) {
  Violations violations;
  evaluate_profiles(
      request, [] { return false; }, violations);
  std::string out;
  for (const Violation& each : violations) out += each.field + ": " + each.description + "\n";
  return out;
}

TEST(EvaluateProfiles, AtTheirOwnSpacingTheyMakeTheSurfaceOfAnImportWithItsUncertainty) {
  const v1::EvaluateProfilesRequest request = six_profiles();
  const v1::EvaluateProfilesResponse out = run_profiles(request);
  v1::ImportSurfaceProfilesRequest import;
  *import.mutable_profiles() = request.profiles();
  import.mutable_surface()->set_tribofilm_shear_strength_pascals(2e6);
  import.mutable_surface()->set_asperity_friction_coefficient(0.1);
  Violations violations;
  const auto surface = import_surface(import, "surfaces/x", seed_lookup(), violations);
  ASSERT_TRUE(surface) << violations.front().field << violations.front().description;
  const v1::SampledSurface& own = out.surfaces(0);
  EXPECT_EQ(own.sampling_step(), 1);
  EXPECT_NEAR(own.spacing_metres(), kSpacing, 1e-12);
  EXPECT_DOUBLE_EQ(own.roughness().composite_rms_height_metres(),
                   surface->composite_rms_height_metres());
  EXPECT_DOUBLE_EQ(own.roughness().asperity_radius_metres(), surface->asperity_radius_metres());
  EXPECT_DOUBLE_EQ(own.roughness().asperity_density_per_square_metre(),
                   surface->asperity_density_per_square_metre());
  EXPECT_DOUBLE_EQ(own.roughness().roughness_product(),
                   surface->asperity_density_per_square_metre() *
                       surface->asperity_radius_metres() * surface->composite_rms_height_metres());
  double imported = 0;
  for (const v1::ParameterProvenance& each : surface->provenance()) {
    if (each.field() == "composite_rms_height_metres") imported = each.standard_uncertainty();
  }
  EXPECT_GT(imported, 0);
  EXPECT_DOUBLE_EQ(own.standard_uncertainty().composite_rms_height_metres(), imported);
  ASSERT_EQ(out.measurements_size(), 6);
  EXPECT_EQ(out.measurements(0).samples(), 2000);
}

TEST(EvaluateProfiles, GroupsHaveTheMeanAndTheScatterOfTheirMoments) {
  v1::EvaluateProfilesRequest request = six_profiles();
  request.mutable_profiles()->RemoveLast();
  request.mutable_profiles()->RemoveLast();
  const v1::EvaluateProfilesResponse out = run_profiles(request);
  ASSERT_EQ(out.groups_size(), 2);
  const v1::ProfileGroup& pinion = out.groups(0);
  EXPECT_EQ(pinion.member(), v1::FLANK_MEMBER_PINION);
  EXPECT_EQ(pinion.direction(), v1::PROFILE_DIRECTION_AXIAL);
  EXPECT_EQ(pinion.profiles(), 3);
  double mean = 0, squares = 0;
  for (int i = 0; i < 3; ++i) mean += out.measurements(i).mean_square_slope() / 3;
  for (int i = 0; i < 3; ++i)
    squares += std::pow(out.measurements(i).mean_square_slope() - mean, 2);
  EXPECT_DOUBLE_EQ(pinion.mean().mean_square_slope(), mean);
  EXPECT_NEAR(pinion.standard_deviation().mean_square_slope(), std::sqrt(squares / 2),
              1e-12 * mean);
  EXPECT_EQ(out.groups(1).profiles(), 1);
  EXPECT_FALSE(out.groups(1).has_standard_deviation());
  EXPECT_FALSE(out.surfaces(0).has_standard_uncertainty()) << "one profile has no spread";
}

TEST(EvaluateProfiles, ALongerSamplingIntervalOfARoughSurfaceHasFewerAndBlunterAsperities) {
  const v1::EvaluateProfilesResponse out = run_profiles(six_profiles());
  std::vector<int> steps;
  for (int i = 0; i < out.surfaces_size(); ++i) {
    const v1::SampledSurface& each = out.surfaces(i);
    steps.push_back(each.sampling_step());
    EXPECT_NEAR(each.spacing_metres(), each.sampling_step() * kSpacing, 1e-12);
    if (i == 0) continue;
    const v1::ProfileRoughness& before = out.surfaces(i - 1).roughness();
    EXPECT_LT(each.roughness().asperity_density_per_square_metre(),
              before.asperity_density_per_square_metre());
    EXPECT_GT(each.roughness().asperity_radius_metres(), before.asperity_radius_metres());
    EXPECT_NEAR(each.roughness().composite_rms_height_metres(),
                before.composite_rms_height_metres(), 0.05 * before.composite_rms_height_metres());
    EXPECT_GT(each.standard_uncertainty().roughness_product(), 0);
  }
  EXPECT_THAT(steps, testing::ElementsAre(1, 2, 3, 4, 6, 8, 12, 16, 24, 32))
      << "50 heights are left";
}

TEST(EvaluateProfiles, TheMomentsOfASampledWaveAreThoseOfItsFormula) {
  v1::EvaluateProfilesRequest request;
  constexpr double kWave = 24;
  request.add_profiles()->set_csv(csv_of(profile_wave(kWave, 2400)));
  request.set_levelling(v1::LEVELLING_MEAN);
  for (const int step : {1, 2, 4}) request.add_sampling_steps(step);
  const v1::EvaluateProfilesResponse out = run_profiles(request);
  for (const v1::SampledSurface& each : out.surfaces()) {
    EXPECT_NEAR(each.wave_length_ratio(), kWave / each.sampling_step(),
                0.01 * kWave / each.sampling_step());
    const double q = 2 * std::numbers::pi * each.sampling_step() / kWave;
    const double m2 = 0.5 * std::pow(300e-9 * std::sin(q) / each.spacing_metres(), 2);
    const double m4 =
        0.5 * std::pow(300e-9 * 4 * std::pow(std::sin(q / 2) / each.spacing_metres(), 2), 2);
    // Both flanks are like the profile: the moments add up (eqs 47, 48).
    EXPECT_NEAR(each.roughness().asperity_density_per_square_metre(),
                m4 / (6 * std::numbers::pi * std::sqrt(3) * m2), 0.01 * m4 / (32 * m2));
  }
}

TEST(EvaluateProfiles, WarnsOfUnresolvedWavesAndOfFlanksThatNobodyMeasured) {
  v1::EvaluateProfilesRequest request;
  std::vector<double> noise = profile_wave(2.5, 500);
  v1::SurfaceProfile& profile = *request.add_profiles();
  profile.set_member(v1::FLANK_MEMBER_PINION);
  profile.set_csv(csv_of(noise));
  std::string codes;
  const v1::EvaluateProfilesResponse out = run_profiles(request);
  for (const v1::RangeWarning& each : out.warnings()) codes += each.code() + " ";
  EXPECT_THAT(codes, HasSubstr("PROFILE_NOT_RESOLVED"));
  EXPECT_THAT(codes, HasSubstr("SURFACE_PARTLY_MEASURED"));
}

TEST(EvaluateProfiles, NamesAllThatIsWrong) {
  EXPECT_THAT(profile_violations({}), HasSubstr("profiles: 0 profiles; allowed: 1 to 24"));
  v1::EvaluateProfilesRequest request;
  request.add_profiles()->set_csv(csv_of(profile_wave(24, 100)));
  for (const int step : {0, 21, 2, 2}) request.add_sampling_steps(step);
  const std::string all = profile_violations(request);
  EXPECT_THAT(all,
              HasSubstr("sampling_steps[0]: 0; allowed: 1 to 20, so that 5 of the 100 heights"));
  EXPECT_THAT(all, HasSubstr("sampling_steps[1]: 21; allowed: 1 to 20"));
  EXPECT_THAT(all, HasSubstr("sampling_steps[2]: 2; allowed: more than the one before, 21"));
  EXPECT_THAT(all, HasSubstr("sampling_steps[3]: 2; allowed: more than the one before, 2"));
  request.clear_sampling_steps();
  request.mutable_profiles(0)->set_csv("position_metres,height_metres\n0,0\n1e-6,x\n");
  EXPECT_THAT(profile_violations(request),
              HasSubstr("profiles[0].csv row 3 column height_metres: \"x\""));
  request.mutable_profiles(0)->set_csv(csv_of(std::vector<double>(100, 7)));
  EXPECT_NE(profile_violations(request), "") << "a smooth profile has no asperities";
}

TEST(EvaluateProfiles, StopsWhenItsCallIsOver) {
  Violations violations;
  EXPECT_THROW(evaluate_profiles(
                   six_profiles(), [] { return true; }, violations),
               Cancelled);
}

}  // namespace
}  // namespace tribodyn::server
