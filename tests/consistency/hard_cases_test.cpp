// Scenes outside of the reference's spectrum, damping and load: the answer is right within its
// error, or says what else is possible.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/driveline/linear_modes.h"
#include "core/refusal.h"
#include "core/study/operating_point.h"
#include "core/study/point_by_marching.h"
#include "core/study/screening.h"
#include "core/study/speed_sweep.h"
#include "tests/support/cruise.h"
#include "tests/support/figure_error.h"
#include "tests/support/random_place.h"
#include "tests/support/reference_data.h"
#include "tests/support/reference_scene.h"
#include "tests/support/run_length.h"

namespace tribodyn {
namespace {

bool warns(const std::vector<RangeWarning>& warnings, const std::string& code) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const RangeWarning& warning) { return warning.code == code; });
}

Scene with_ripple(double factor) {
  Scene scene = reference_scene();
  FourierSeries& k = scene.gear_set.series.mesh_stiffness;
  for (std::vector<double>* series : {&k.sine, &k.cosine}) {
    for (double& c : *series) c *= factor;
  }
  return scene;
}

Scene with_error_order(int order, double amplitude) {
  Scene scene = reference_scene();
  FourierSeries& e = scene.gear_set.series.static_transmission_error;
  e.sine.resize(static_cast<std::size_t>(order), 0);
  e.cosine.resize(static_cast<std::size_t>(order), 0);
  e.sine.back() += amplitude;
  return scene;
}

PointResult marched_from(const Scene& scene, const OperatingCondition& condition,
                         const PointResult& r) {
  PointOptions march;
  march.method = SteadyStateMethod::kMarch;
  march.tolerance = 1e-6;
  march.march_step_tolerance = 1e-9;
  march.march_settling_tolerance = 1e-7;
  march.carried_state = carried_from(r);
  return solve_operating_point(scene, condition, march);
}

// From there Newton's method would reach another attractor, at which the flanks are thrown through
// the backlash by millimetres and 60 % of the power is lost.
TEST(HardCases, NewtonsMethodDoesNotLeaveTheStartForARemoteAttractor) {
  const Scene scene = with_ripple(2.15);
  for (const double speed : {141.0, 141.5, 142.0, 142.5, 143.25, 144.0, 146.0}) {
    if (!full_run() && speed != 142) continue;
    SCOPED_TRACE(speed);
    const PointResult r = solve_operating_point(scene, cruise(speed), {});
    EXPECT_LT(r.inefficiency_rms.value(), 3);
    EXPECT_LT(r.dynamic_transmission_error.maximum, 4 * scene.gear_set.dynamics.half_backlash);
    EXPECT_GT(r.dynamic_transmission_error.minimum, -4 * scene.gear_set.dynamics.half_backlash);
  }
}

TEST(HardCases, AnOrderThatFewStepsAliasIsInTheErrorOrInTheSteps) {
  for (const int order : {9, 12, 16, 20, 24, 28, 40, 48, 72, 96, 130}) {
    const Scene scene = with_error_order(order, 30e-9);
    for (const double speed : {20.0, 40.0, 60.0, 100.0, 140.0}) {
      if ((kShortRun || !full_run()) && speed != 40 && order != 28) continue;
      SCOPED_TRACE(testing::Message() << "order " << order << " at " << speed << " km/h");
      const PointResult r = solve_operating_point(scene, cruise(speed), {});
      ASSERT_TRUE(r.settled);
      const double estimate = r.estimated_relative_error.value();
      EXPECT_LE(estimate, PointOptions{}.tolerance);
      EXPECT_LE(true_error(r, marched_from(scene, cruise(speed), r)), estimate);
    }
  }
}

TEST(HardCases, LoadsThatPassFromPairToPairWithinAnIntervalAreInTheErrorOrInTheSteps) {
  for (const int intervals : {24, 97, 384}) {
    Scene scene = reference_scene();
    resample_tables(scene.gear_set.tables, intervals, true);
    for (const double speed : {30.0, 100.0}) {
      SCOPED_TRACE(testing::Message() << intervals << " intervals at " << speed << " km/h");
      const PointResult r = solve_operating_point(scene, cruise(speed), {});
      ASSERT_TRUE(r.settled);
      EXPECT_LE(true_error(r, marched_from(scene, cruise(speed), r)),
                r.estimated_relative_error.value());
      PreparedScene prepared(scene);
      const PointFigures screened = screen_point(prepared, cruise(speed), {});
      EXPECT_LE(true_error(screened, marched_from(scene, cruise(speed), r)),
                screened.estimated_relative_error.value());
      if (kShortRun) return;
    }
  }
}

/// That an answer is settled within its error, or says that it is not and is an average.
void expect_settled_or_said(const PointResult& r) {
  EXPECT_LT(static_cast<double>(r.statistics.contact_solutions),
            1.3 * kMostContactsOfAutomaticMarch);
  if (r.settled) {
    EXPECT_LE(r.estimated_relative_error.value(), PointOptions{}.tolerance);
  } else {
    EXPECT_TRUE(warns(r.warnings, "NOT_SETTLED"));
  }
}

// The response barely attracts, and is approached in thousands of mesh cycles.
TEST(HardCases, AShaftThatHardlyDampsIsAnsweredWithinTheLimitOfWork) {
  const OperatingCondition condition = cruise(97.6);
  const PointResult damped = solve_operating_point(reference_scene(), condition, {});
  for (const double factor : {0.1, 0.03, 0.01}) {
    SCOPED_TRACE(factor);
    Scene scene = reference_scene();
    scene.gear_set.dynamics.pinion_shaft_damping *= factor;
    scene.gear_set.dynamics.gear_shaft_damping *= factor;
    const PointResult r = solve_operating_point(scene, condition, {});
    expect_settled_or_said(r);
    EXPECT_NEAR(r.inefficiency_energy_mean.value() / damped.inefficiency_energy_mean.value(), 1,
                3e-3);
    if (kShortRun) return;
  }
}

TEST(HardCases, TorquesNearZeroAreSettledOrSayThatTheyAreNot) {
  const Scene scene = reference_scene();
  PreparedScene prepared(scene);
  for (const double torque : {0.05, 5e-3, 1e-3, 1e-4, -0.02}) {
    for (const double speed : {20.0, 100.0, 200.0, 300.0}) {
      if (!full_run() && speed == 200 && torque != 1e-4) continue;
      SCOPED_TRACE(testing::Message() << torque << " N m at " << speed << " rad/s");
      const OperatingCondition condition = prescribed(torque, speed);
      const PointResult r = solve_prepared_point(prepared, condition, {});
      expect_settled_or_said(r);
      if (r.settled) {
        EXPECT_LE(true_error(r, marched_from(scene, condition, r)),
                  r.estimated_relative_error.value());
      } else {
        EXPECT_TRUE(warns(r.warnings, "RATTLES"));
      }
      if (kShortRun) return;
    }
  }
}

/// RMS inefficiency at two speeds of a sweep down from 180 km/h.
std::vector<double> down_sweep(double step) {
  SweepOptions options;
  options.direction = SweepDirection::kDown;
  std::vector<double> speeds, out;
  for (double speed = 180; speed > 59; speed -= step) speeds.push_back(speed / 3.6);
  for (const SweepPoint& at : sweep_speed(reference_scene(), speeds, 0, options)) {
    const double speed = 3.6 * at.vehicle_speed;
    if (std::abs(speed - 120) < 1e-6 || std::abs(speed - 140) < 1e-6) {
      out.push_back(at.result.value().inefficiency_rms.value());
    }
  }
  return out;
}

// The period doubles between 155.8 and 149.4 km/h only; below, the doubled response goes on.
TEST(HardCases, ACurveDoesNotDependOnTheNumberOfItsPoints) {
  const std::vector<double> wide = down_sweep(20), narrow = down_sweep(5);
  ASSERT_EQ(wide.size(), 2u);
  ASSERT_EQ(narrow.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(wide[i] / narrow[i], 1, 2e-3);
  EXPECT_GT(wide[0], 1.5) << "the doubled response at 120 km/h";
}

// Two responses of the reference axle: between 65.2 and 71.4 km/h, and between 118 and 149.
TEST(CoexistingResponses, ArePointedOutWhereverTheyAre) {
  const Scene scene = reference_scene();
  PreparedScene prepared(scene);
  for (const auto& [speed, coexist] : {std::pair{30.0, false},
                                       {60.0, false},
                                       {67.0, true},
                                       {70.0, true},
                                       {78.0, false},
                                       {90.0, false},
                                       {105.0, false},
                                       {121.0, true},
                                       {135.0, true},
                                       {147.0, true},
                                       {165.0, false}}) {
    SCOPED_TRACE(speed);
    EXPECT_EQ(warns(solve_operating_point(scene, cruise(speed), {}).warnings, "RESPONSES_COEXIST"),
              coexist);
    EXPECT_EQ(warns(screen_point(prepared, cruise(speed), {}).warnings, "RESPONSES_COEXIST"),
              coexist);
  }
}

TEST(CoexistingResponses, AreFoundByTheLargeVibrationStart) {
  for (const auto& [speed, period] : {std::pair{67.5, 1}, {120.0, 2}, {130.0, 2}, {145.0, 2}}) {
    SCOPED_TRACE(speed);
    PointOptions options;
    options.start = PointStart::kLargeVibration;
    const PointResult loud = solve_operating_point(reference_scene(), cruise(speed), options);
    EXPECT_TRUE(loud.settled);
    EXPECT_TRUE(loud.contact_loss);
    EXPECT_EQ(loud.period_in_mesh_cycles, period);
    EXPECT_TRUE(warns(loud.warnings, "RESPONSES_COEXIST"));
    options.start = PointStart::kQuasiStatic;
    options.probe_coexisting_response = true;
    const PointResult quiet = solve_operating_point(reference_scene(), cruise(speed), options);
    EXPECT_FALSE(quiet.contact_loss);
    ASSERT_TRUE(quiet.coexisting_response.has_value());
    EXPECT_NEAR(quiet.coexisting_response->inefficiency_rms / loud.inefficiency_rms.value(), 1,
                3e-3);
    if (kShortRun) return;
  }
}

TEST(LinearModes, AreThoseOfTheReference) {
  const nlohmann::json dynamics = load_reference("reference_gear_set.json").at("dynamics");
  const Scene scene = reference_scene();
  const PreparedGearSet set(scene.gear_set, scene.solid, scene.options);
  for (std::size_t i = 0; i < 3; ++i) {
    const double hertz = set.modes()[i].frequency / (2 * std::numbers::pi);
    EXPECT_NEAR(hertz / dynamics.at("linear_modes_Hz").at(i + 1).get<double>(), 1, 2e-3);
    EXPECT_NEAR(set.modes()[i].damping / dynamics.at("linear_mode_damping").at(i + 1).get<double>(),
                1, 2e-2);
  }
}

}  // namespace
}  // namespace tribodyn
