// The march over mesh phase against an implementation in time that shares no code with it.
#include <gtest/gtest.h>

#include "core/study/operating_point.h"
#include "tests/support/paths.h"
#include "tests/support/reference_scene.h"
#include "tests/yardstick/yardstick_data.h"
#include "tests/yardstick/yardstick_orbit.h"

namespace tribodyn {
namespace {

constexpr double kAgreement = 1e-6;

struct AgreementPlace {
  const char* name;
  double kilometres_per_hour;
  PointStart start = PointStart::kQuasiStatic;
  bool isothermal = false;
  bool newtonian = false;
  double ascent_angle = 0;  // [rad]; downhill the wheel drives: coast
  double acceleration = 0;  // [m/s2]; not 0: an instant of a drive cycle
};

class YardstickAgreement : public testing::TestWithParam<AgreementPlace> {};

TEST_P(YardstickAgreement, TransmissionErrorAndInefficiency) {
  const AgreementPlace& place = GetParam();
  const double speed = place.kilometres_per_hour / 3.6;
  Scene scene = reference_scene();
  scene.options.isothermal = place.isothermal;
  scene.options.newtonian = place.newtonian;
  OperatingCondition condition;
  condition.vehicle_speed = speed;
  condition.ascent_angle = place.ascent_angle;
  condition.acceleration = place.acceleration;
  if (place.acceleration != 0) condition.kind = OperatingCondition::Kind::kDriveCycleSnapshot;
  PointOptions options;
  options.tolerance = 1e-6;
  options.start = place.start;
  options.march_step_tolerance = 1e-9;
  options.march_settling_tolerance = 1e-7;
  const PointResult ours = solve_operating_point(scene, condition, options);
  ASSERT_TRUE(ours.settled);
  ASSERT_EQ(ours.pinion_torque < 0, place.ascent_angle < 0 || place.acceleration < 0);

  const auto worked = yardstick::read_json_file(test_data_file("worked_points.json"));
  const auto gear = yardstick::read_json_file(test_data_file("reference_gear_set.json"));
  yardstick::FrictionOptions friction;
  friction.isothermal = place.isothermal;
  friction.newtonian = place.newtonian;
  yardstick::VehicleParameters vehicle = yardstick::read_vehicle(gear);
  vehicle.ascent_angle = place.ascent_angle;
  vehicle.acceleration = place.acceleration;
  const yardstick::GearPairSystem system(
      yardstick::read_gear_pair(gear), vehicle,
      yardstick::read_orbit_friction(worked.at("orbit_inputs").at("values"), friction),
      yardstick::FrictionArms::kFromVelocities);
  // Our section, 0.1 % off, is only where its own shooting starts: it must find its own orbit.
  yardstick::SectionState start;
  start.pinion_shaft_twist = 1.001 * ours.section_state.pinion_shaft_twist;
  start.gear_shaft_twist = 0.999 * ours.section_state.gear_shaft_twist;
  start.pinion_shaft_speed = 1.001 * ours.section_state.pinion_shaft_speed;
  start.pinion_speed = 1.001 * ours.section_state.pinion_speed;
  start.gear_speed = 1.001 * ours.section_state.gear_speed;
  start.gear_shaft_speed = 1.001 * ours.section_state.wheel_speed;
  start.advance_with_error = 1.001 * ours.section_state.mesh_deflection;
  const yardstick::Orbit theirs =
      yardstick::find_periodic_orbit(system, start, 0.999 * ours.pinion_torque, speed);
  ASSERT_TRUE(theirs.converged) << "mismatch " << theirs.mismatch;

  const auto expect_near = [](double a, double b, const char* what) {
    EXPECT_NEAR(a, b, kAgreement * std::abs(b)) << what << ", relative " << a / b - 1;
  };
  const yardstick::MeshCycle& cycle = theirs.cycle;
  expect_near(ours.pinion_torque, cycle.input_torque, "T_s");
  expect_near(ours.inefficiency_rms.value(), cycle.rms_inefficiency, "RMS inefficiency");
  expect_near(ours.inefficiency_energy_mean.value(), cycle.energy_mean_inefficiency, "energy mean");
  expect_near(ours.dynamic_transmission_error.minimum, cycle.transmission_error.minimum, "DTE min");
  expect_near(ours.dynamic_transmission_error.mean, cycle.transmission_error.mean, "DTE mean");
  expect_near(ours.dynamic_transmission_error.maximum, cycle.transmission_error.maximum, "DTE max");
  expect_near(ours.pinion_friction_torque.mean, cycle.pinion_friction_torque.mean, "T_fr,p mean");
}

INSTANTIATE_TEST_SUITE_P(
    Speeds, YardstickAgreement,
    testing::Values(
        AgreementPlace{"v20", 20}, AgreementPlace{"v37_5", 37.5}, AgreementPlace{"v67_5_up", 67.5},
        AgreementPlace{"v67_5_down", 67.5, PointStart::kLargeVibration},
        AgreementPlace{"v72_5", 72.5}, AgreementPlace{"v80", 80}, AgreementPlace{"v100", 100},
        AgreementPlace{"v140", 140},
        AgreementPlace{"v100_isothermal", 100, PointStart::kQuasiStatic, true},
        AgreementPlace{"v100_newtonian", 100, PointStart::kQuasiStatic, false, true},
        AgreementPlace{"v72_5_coast", 72.5, PointStart::kQuasiStatic, false, false, -0.05},
        AgreementPlace{"v100_coast", 100, PointStart::kQuasiStatic, false, false, -0.08},
        AgreementPlace{"v32_accelerating", 32, PointStart::kQuasiStatic, false, false, 0, 0.94},
        AgreementPlace{"v50_accelerating_uphill", 50, PointStart::kQuasiStatic, false, false, 0.03,
                       0.52},
        AgreementPlace{"v100_braking_uphill", 100, PointStart::kQuasiStatic, false, false, 0.02,
                       -1.04}),
    [](const auto& place) { return std::string(place.param.name); });

}  // namespace
}  // namespace tribodyn
