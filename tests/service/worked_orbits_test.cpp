// Compares an operating point and a curve, computed through store, jobs and core, with independent
// solutions.
#include <gtest/gtest.h>

#include "tests/service/reference_data.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

constexpr double kTolerance = 1e-5;  // accuracy of the worked points
constexpr double kSolverTolerance = 1e-7;

JsonValue orbit(const std::string& name) {
  const JsonValue data = load_reference("worked_points.json");
  for (const JsonValue& entry : at(data, "orbits").list_value().values()) {
    if (at(entry, "name").string_value() == name) return at(entry, "expected");
  }
  throw std::runtime_error("no orbit " + name);
}

void expect_orbit(const v1::CurvePoint& point, const std::string& name) {
  const JsonValue expected = orbit(name);
  const v1::PointResult& result = point.result();
  EXPECT_TRUE(result.settled()) << point.refusal_message();
  const auto near = [&](double actual, const char* key) {
    EXPECT_NEAR(actual / number(expected, key), 1, kTolerance) << name << " " << key;
  };
  near(result.pinion_torque_newton_metres(), "T_s");
  near(result.inefficiency_rms_percent(), "In_rms");
  near(result.inefficiency_energy_mean_percent(), "In_energy");
  near(result.dynamic_transmission_error_metres().minimum(), "dte_min");
  near(result.dynamic_transmission_error_metres().maximum(), "dte_max");
  near(result.pinion_friction_torque_newton_metres().mean(), "Tfp_mean");
}

TEST(WorkedOrbits, AnOperatingPointAgreesThroughTheWholeService) {
  Bench bench{StudyFunctions()};
  v1::Simulation simulation = point_simulation();
  simulation.mutable_model_options()->set_preset(v1::ModelOptions::PAPER);
  simulation.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(100);
  simulation.mutable_solver_options()->set_tolerance(kSolverTolerance);
  const std::string name = bench.create(simulation);
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::SUCCEEDED)) << bench.get(name).error().message();
  expect_orbit(bench.get(name).result().points(0), "L1_100_up");
}

TEST(WorkedOrbits, ACurveAgreesThroughTheWholeService) {
  Bench bench{StudyFunctions()};
  v1::Simulation simulation = curve_simulation();
  simulation.mutable_model_options()->set_preset(v1::ModelOptions::PAPER);
  simulation.set_lubricant("lubricants/paper-fluid-1");
  v1::InefficiencyCurveStudy* curve = simulation.mutable_inefficiency_curve();
  curve->set_first_speed_kilometres_per_hour(20);
  curve->set_last_speed_kilometres_per_hour(140);
  curve->set_speed_step_kilometres_per_hour(40);
  simulation.mutable_solver_options()->set_tolerance(kSolverTolerance);
  const std::string name = bench.create(simulation);
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::SUCCEEDED)) << bench.get(name).error().message();
  const v1::SimulationResult result = bench.get(name).result();
  ASSERT_EQ(result.points_size(), 4);
  expect_orbit(result.points(0), "L1_20_up");
  expect_orbit(result.points(2), "L1_100_up");
  expect_orbit(result.points(3), "L1_140_up");
}

}  // namespace
}  // namespace tribodyn::server
