// Responses that do not repeat, or that a march cannot follow for long: averages have an error that
// holds, and every march ends at its limit of work.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/study/operating_point.h"
#include "core/study/point_by_marching.h"
#include "core/study/response_warnings.h"
#include "tests/support/cruise.h"
#include "tests/support/reference_scene.h"
#include "tests/support/refusal_reason.h"
#include "tests/support/run_length.h"

namespace tribodyn {
namespace {

bool warns(const PointResult& r, const std::string& code) {
  return std::any_of(r.warnings.begin(), r.warnings.end(),
                     [&](const RangeWarning& warning) { return warning.code == code; });
}

/// The reference with so much ripple of its mesh stiffness that flanks rattle at 141 to 146 km/h.
Scene rippled_scene() {
  constexpr double kRipple = 2.15;
  Scene scene = reference_scene();
  FourierSeries& stiffness = scene.gear_set.series.mesh_stiffness;
  for (std::vector<double>* terms : {&stiffness.sine, &stiffness.cosine}) {
    for (double& each : *terms) each *= kRipple;
  }
  return scene;
}

PointOptions marched(int mesh_cycles, PointStart start = PointStart::kQuasiStatic) {
  PointOptions out;
  out.method = SteadyStateMethod::kMarch;
  out.start = start;
  out.maximum_mesh_cycles = mesh_cycles;
  return out;
}

/// The figures that an error is estimated of differ by no more than both errors explain.
void expect_agreement(const PointResult& a, const PointResult& b) {
  if (!a.estimated_relative_error || !b.estimated_relative_error) return;
  // Of 24 comparisons of three figures one in a thousand runs differs more: each error is half of
  // the width of a 95 % interval.
  constexpr double kWider = 1.6;
  const double error =
      kWider * (a.estimated_relative_error.value() + b.estimated_relative_error.value());
  EXPECT_NEAR(a.inefficiency_rms.value() / b.inefficiency_rms.value(), 1, error);
  EXPECT_NEAR(a.inefficiency_energy_mean.value() / b.inefficiency_energy_mean.value(), 1, error);
  EXPECT_NEAR(a.pinion_torque / b.pinion_torque, 1, error);
  EXPECT_NEAR(a.wheel_torque / b.wheel_torque, 1, error);
}

class Rattle : public testing::TestWithParam<double> {};

TEST_P(Rattle, ShortAveragesAgreeWithALongOneWithinTheErrorsThatTheyState) {
  if (kShortRun) GTEST_SKIP() << "minutes under sanitizers";
  const Scene scene = rippled_scene();
  PreparedScene prepared(scene);
  const PointResult exact =
      solve_prepared_point(prepared, cruise(GetParam()), marched(full_run() ? 8000 : 2000));
  EXPECT_LT(exact.estimated_relative_error.value(), 0.03);
  PointOptions loud;
  loud.start = PointStart::kLargeVibration;
  std::vector<PointResult> averages;
  const PointOptions longer = marched(1000);  // long enough to have an error at every speed
  for (const PointOptions& options : {PointOptions(), loud, longer}) {
    const PointResult r = solve_prepared_point(prepared, cruise(GetParam()), options);
    EXPECT_FALSE(r.settled);
    EXPECT_EQ(warns(r, "RATTLES"), options.method == SteadyStateMethod::kAutomatic);
    EXPECT_TRUE(warns(r, "NOT_SETTLED"));
    EXPECT_LT(r.estimated_relative_error.value_or(0), 0.15);
    expect_agreement(r, exact);
    averages.push_back(r);
  }
  EXPECT_TRUE(averages.back().estimated_relative_error.has_value());
  expect_agreement(averages[0], averages[1]);
}

INSTANTIATE_TEST_SUITE_P(Speeds, Rattle, testing::Values(141, 142.5, 144, 146), [](const auto& at) {
  return "At" + std::to_string(static_cast<int>(10 * at.param));
});

TEST(RattleRecord, IsOfTheTransientSearchAndAverageTogetherAtMostTheMeshCyclesAllowed) {
  constexpr int kAllowed = 50;
  for (const SteadyStateMethod method :
       {SteadyStateMethod::kAutomatic, SteadyStateMethod::kMarch}) {
    PointOptions options = marched(kAllowed);
    options.method = method;
    const PointResult r = solve_operating_point(rippled_scene(), cruise(142.5), options);
    EXPECT_FALSE(r.settled);
    EXPECT_LE(r.statistics.mesh_cycles, kAllowed);
    EXPECT_LE(r.recorded_mesh_cycles, r.statistics.mesh_cycles);
  }
}

TEST(RattleRecord, GoesOnUntilTheErrorIsWithinTheTolerance) {
  PointOptions loose = marched(2000), tight = loose;
  loose.tolerance = 0.1;
  tight.tolerance = 0.05;
  const PointResult few = solve_operating_point(rippled_scene(), cruise(144), loose);
  const PointResult many = solve_operating_point(rippled_scene(), cruise(144), tight);
  EXPECT_LE(few.estimated_relative_error.value(), loose.tolerance);
  EXPECT_LE(many.estimated_relative_error.value(), tight.tolerance);
  EXPECT_LT(few.statistics.mesh_cycles, many.statistics.mesh_cycles);
  EXPECT_LT(many.statistics.mesh_cycles, loose.maximum_mesh_cycles);
}

TEST(RattleRecord, BalancesPowerAndHoldsTheMeanSpeed) {
  const PointResult r = solve_operating_point(rippled_scene(), cruise(144), marched(300));
  const PowerBalance& b = r.power_balance;
  const double gap =
      b.input - b.output - b.friction - b.shaft_damping - b.mesh_damping - b.stored - b.parametric;
  EXPECT_NEAR(gap, 0, 1e-7 * b.input);
  const double cycle_frequency =
      r.mean_pinion_speed * rippled_scene().gear_set.pinion_teeth / (2 * std::numbers::pi);
  EXPECT_NEAR(r.mesh_frequency / cycle_frequency, 1, 1e-4);
}

TEST(RattleRecord, EndsWhereTheHistoryBegins) {
  PointOptions options = marched(60);
  options.history = {{HistoryColumn::kTime, HistoryColumn::kPinionSpeed}, 2, 16};
  const PointResult r = solve_operating_point(rippled_scene(), cruise(144), options);
  ASSERT_EQ(r.history.values[0].size(), 32u);
  EXPECT_EQ(r.history.values[0].front(), 0);
  EXPECT_NEAR(r.history.values[1].front(), r.section_state.pinion_speed,
              1e-9 * r.section_state.pinion_speed);
}

struct MarchedWork {
  std::string refusal;  ///< "none" if there is an answer
  long contacts;
};

MarchedWork march(const Scene& scene, const OperatingCondition& condition,
                  const PointOptions& options) {
  PreparedScene prepared(scene);
  const OperatingTarget target = target_of(scene, condition);
  ContactTally tally;
  const PointProblem problem{prepared.contacts(), prepared.gear_set(), target, options, tally};
  const std::string refusal = refusal_reason([&] {
    solve_by_marching(problem, options.start, options.carried_state, options.history, std::nullopt);
  });
  return {refusal, tally.solutions};
}

// A mesh cycle takes up to a second there: the limit ends it inside.
TEST(WorkLimit, EndsAutomaticMarchesAtTheLowestSpeeds) {
  struct Place {
    double sump_celsius;
    OperatingCondition condition;
  };
  for (const Place& place : std::vector<Place>{{40, prescribed(40, 0.1)},
                                               {40, prescribed(50, 0.01)},
                                               {-35, cruise(0.1)},
                                               {-40, cruise(0.1)},
                                               {-45, cruise(0.1)}}) {
    const MarchedWork marched = march(reference_scene(1, place.sump_celsius), place.condition, {});
    EXPECT_EQ(marched.refusal, "TOO_SLOW_TO_MARCH");
    EXPECT_LT(static_cast<double>(marched.contacts), 1.02 * kMostContactsOfAutomaticMarch);
  }
}

TEST(WorkLimit, EndsAutomaticMarchesThatDoNotSettle) {
  const MarchedWork marched = march(rippled_scene(), cruise(144), {});
  EXPECT_EQ(marched.refusal, "none");
  EXPECT_LT(static_cast<double>(marched.contacts), 1.02 * kMostContactsOfAutomaticMarch);
}

TEST(WorkLimit, OfARequestedMarchGrowsWithTheMeshCyclesAllowed) {
  const MarchedWork marched = march(reference_scene(), prescribed(40, 0.1), tribodyn::marched(100));
  EXPECT_EQ(marched.refusal, "TOO_SLOW_TO_MARCH");
  EXPECT_LT(static_cast<double>(marched.contacts), 1.02 * 100 * kMostContactsPerMeshCycle);
}

TEST(BarelyAttracts, WarnsWhereTheMultiplierIsWithinItsDoubtOfOne) {
  for (const double multiplier : {0.9999, 1.0, 1.0001}) {
    EXPECT_TRUE(barely_attracts_warning(multiplier, 3e-4)) << multiplier;
  }
  for (const double multiplier : {0.0, 0.9996, 1.0004}) {
    EXPECT_FALSE(barely_attracts_warning(multiplier, 3e-4)) << multiplier;
  }
}

TEST(BarelyAttracts, IsToldOfAMarchedResponseWhoseShaftsAreHardlyDamped) {
  Scene scene = reference_scene();
  EXPECT_FALSE(warns(solve_operating_point(scene, cruise(60), marched(1000)), "BARELY_ATTRACTS"));
  scene.gear_set.dynamics.pinion_shaft_damping *= 0.003;
  scene.gear_set.dynamics.gear_shaft_damping *= 0.003;
  const PointResult r = solve_operating_point(scene, cruise(60), marched(1000));
  EXPECT_TRUE(r.settled);
  EXPECT_TRUE(r.estimated_relative_error.has_value());
  EXPECT_NEAR(r.statistics.largest_multiplier, 1, 3e-4);
  EXPECT_TRUE(warns(r, "BARELY_ATTRACTS"));
}

}  // namespace
}  // namespace tribodyn
