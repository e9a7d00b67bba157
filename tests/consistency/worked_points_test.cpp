#include <gtest/gtest.h>

#include <cmath>

#include "core/study/operating_point.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

void expect_close(const nlohmann::json& expected, const char* name, double value,
                  double tolerance) {
  if (expected.at(name).is_null()) {  // the file's Infinity
    EXPECT_TRUE(std::isinf(value)) << name;
    return;
  }
  const double wanted = expected.at(name);
  EXPECT_NEAR(value, wanted, tolerance * std::abs(wanted)) << name;
}

/// `block`: the list of worked orbits.
void expect_worked_orbits(const char* block) {
  const nlohmann::json file = load_reference("worked_points.json");
  const double tolerance = file.at("suggested_tolerance").at("orbits_relative");
  for (const nlohmann::json& orbit : file.at(block)) {
    SCOPED_TRACE(orbit.at("name").get<std::string>());
    Scene scene = reference_scene();
    // The worked orbits keep the arms of the tables while speeds fluctuate; see model_options.h.
    scene.options.tabulated_friction_arms = true;
    OperatingCondition condition;
    condition.vehicle_speed = orbit.at("speed_kilometres_per_hour").get<double>() / 3.6;
    condition.ascent_angle = orbit.value("ascent_angle_radians", 0.0);
    PointOptions options;
    options.tolerance = 1e-7;
    if (orbit.at("branch") == "down-sweep") options.start = PointStart::kLargeVibration;
    const PointResult r = solve_operating_point(scene, condition, options);
    ASSERT_TRUE(r.settled);
    EXPECT_EQ(r.period_in_mesh_cycles, 1);
    const nlohmann::json& e = orbit.at("expected");
    expect_close(e, "T_s", r.pinion_torque, tolerance);
    expect_close(e, "In_rms", r.inefficiency_rms.value(), tolerance);
    expect_close(e, "In_energy", r.inefficiency_energy_mean.value(), tolerance);
    expect_close(e, "dte_min", r.dynamic_transmission_error.minimum, tolerance);
    expect_close(e, "dte_mean", r.dynamic_transmission_error.mean, tolerance);
    expect_close(e, "dte_max", r.dynamic_transmission_error.maximum, tolerance);
    expect_close(e, "Tfp_min", r.pinion_friction_torque.minimum, tolerance);
    expect_close(e, "Tfp_mean", r.pinion_friction_torque.mean, tolerance);
    expect_close(e, "Tfp_max", r.pinion_friction_torque.maximum, tolerance);
    expect_close(e, "T_c_max", r.contact_temperature.maximum, tolerance);
    expect_close(e, "lambda_min", r.film_ratio.minimum, tolerance);
    expect_close(e, "pmax", r.maximum_pressure.maximum, tolerance);
    const nlohmann::json& s = orbit.at("section_state");
    expect_close(s, "d_phi_sp", r.section_state.pinion_shaft_twist, tolerance);
    expect_close(s, "d_phi_gw", r.section_state.gear_shaft_twist, tolerance);
    expect_close(s, "w_s", r.section_state.pinion_shaft_speed, tolerance);
    expect_close(s, "w_p", r.section_state.pinion_speed, tolerance);
    expect_close(s, "w_g", r.section_state.gear_speed, tolerance);
    expect_close(s, "w_w", r.section_state.wheel_speed, tolerance);
    expect_close(s, "y", r.section_state.mesh_deflection, tolerance);
  }
}

TEST(WorkedPoints, OrbitsAreFoundFromAStartOfOurOwnTo1e5) { expect_worked_orbits("orbits"); }

TEST(WorkedPoints, CoastOrbitsAreFoundFromAStartOfOurOwnTo1e5) {
  expect_worked_orbits("coast_orbits");
}

}  // namespace
}  // namespace tribodyn
