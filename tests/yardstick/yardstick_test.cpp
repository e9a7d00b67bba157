// The yardstick against the worked contacts and orbits, computed by others with other methods.
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/paths.h"
#include "yardstick_data.h"

namespace tribodyn::yardstick {
namespace {

using nlohmann::json;

constexpr double kContactTolerance = 1e-9;
// The worked orbits were integrated at 1e-11. Their extremes seem to be those of the samples taken.
constexpr double kOrbitTolerance = 1e-7;
constexpr double kExtremeTolerance = 1e-6;

const json& worked_points() {
  static const json worked_points = read_json_file(test_data_file("worked_points.json"));
  return worked_points;
}

GearPairSystem make_system(FrictionArms arms) {
  const json gear_set = read_json_file(test_data_file("reference_gear_set.json"));
  return GearPairSystem(read_gear_pair(gear_set), read_vehicle(gear_set),
                        read_orbit_friction(worked_points().at("orbit_inputs").at("values")), arms);
}

// Zeros are compared absolutely; "Infinity" stands for infinity.
testing::AssertionResult Matches(const json& expected, double actual, double tolerance) {
  if (expected.is_string()) {
    if (std::isinf(actual)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << actual << " instead of infinity";
  }
  const double reference = expected;
  const double scale = reference == 0.0 ? 1.0 : std::abs(reference);
  const double error = (actual - reference) / scale;
  if (std::abs(error) <= tolerance) return testing::AssertionSuccess();
  return testing::AssertionFailure() << actual << " instead of " << reference << ", relative error "
                                     << error << " > " << tolerance;
}

std::vector<std::string> names_of(const char* block) {
  std::vector<std::string> names;
  for (const json& item : worked_points().at(block)) names.push_back(item.at("name"));
  return names;
}

const json& find(const char* block, const std::string& name) {
  for (const json& item : worked_points().at(block)) {
    if (item.at("name") == name) return item;
  }
  throw std::out_of_range(name);
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& character : name) {
    if (std::isalnum(static_cast<unsigned char>(character)) == 0) character = '_';
  }
  return name;
}

class WorkedContact : public testing::TestWithParam<std::string> {};

TEST_P(WorkedContact, EveryLeafMatches) {
  const json& worked = find("contacts", GetParam());
  const json& expected = worked.at("expected");
  for (const int quadrature_nodes : {16, 64}) {
    SCOPED_TRACE(quadrature_nodes);
    const ContactCase contact = read_contact_case(worked.at("input"), quadrature_nodes);
    const ContactResult result = contact.friction.evaluate(contact.input);
    const std::vector<std::pair<const char*, double>> leaves = {
        {"W_EHL", result.film_load},
        {"W_asp", result.asperity_load},
        {"A_EHL", result.film_area},
        {"A_asp", result.asperity_area},
        {"a_c", result.semi_major_axis},
        {"b_c", result.semi_minor_axis},
        {"p_max", result.maximum_pressure},
        {"theta", result.entrainment_angle},
        {"R_e", result.entrainment_radius},
        {"R_s", result.side_radius},
        {"U_eff", result.entrainment_speed},
        {"V_s", result.sliding_speed},
        {"eta_in", contact.friction.inlet_viscosity()},
        {"alpha_in", contact.friction.inlet_pressure_viscosity_coefficient()},
        {"Z", contact.friction.pressure_viscosity_index()},
        {"E_prime", contact.friction.reduced_modulus()},
        {"h_cen", result.central_film_thickness},
        {"lambda_s", result.film_parameter},
        {"gamma_dot", result.shear_rate},
        {"T_c", result.temperature},
        {"dT_flash", result.flash_temperature_rise},
        {"dT_oil", result.film_temperature_rise},
        {"l_p", result.pinion_active_length},
        {"l_g", result.gear_active_length},
        {"R_cf", result.film_thermal_resistance},
        {"R_fp", result.pinion_thermal_resistance},
        {"R_fg", result.gear_thermal_resistance},
        {"a_h", result.heat_partition},
        {"tau_bar", result.mean_shear_stress},
        {"F_v", result.viscous_friction},
        {"F_b", result.boundary_friction},
        {"F_fr", result.friction},
        {"q_dot", result.heat_rate},
        {"mu", result.friction / contact.input.load},
        {"n_clip_switches", static_cast<double>(result.limiting_stress_switches)},
    };
    EXPECT_EQ(leaves.size() + 1, expected.size()) << "every leaf but `status` is compared";
    for (const auto& [name, value] : leaves) {
      EXPECT_TRUE(Matches(expected.at(name), value, kContactTolerance)) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, WorkedContact, testing::ValuesIn(names_of("contacts")), test_name);

TEST(Friction, AsperityIntegralMeetsClosedForms) {
  for (const double l : {0.0, 0.5, 1.0, 2.0, 3.0, 5.0}) {
    const double density = std::exp(-0.5 * l * l) / std::sqrt(2.0 * std::numbers::pi);
    const double tail = 0.5 * std::erfc(l / std::numbers::sqrt2);
    EXPECT_NEAR(asperity_integral(0.0, l), tail, 1e-14 * tail) << l;
    // The closed form of order two loses digits as l grows.
    EXPECT_NEAR(asperity_integral(2.0, l), (1.0 + l * l) * tail - l * density,
                1e-14 * tail * l + 1e-15)
        << l;
  }
  // int_0^inf t^(5/2) exp(-t^2/2) dt = 2^(3/4) Gamma(7/4)
  const double at_zero =
      std::pow(2.0, 0.75) * std::tgamma(1.75) / std::sqrt(2.0 * std::numbers::pi);
  EXPECT_NEAR(asperity_integral(2.5, 0.0), at_zero, 1e-14);
}

TEST(System, VelocityArmsTakeOutExactlyTheFrictionPower) {
  const GearPairSystem system = make_system(FrictionArms::kFromVelocities);
  for (const json& orbit : worked_points().at("orbits")) {
    const SectionState section = read_section_state(orbit.at("section_state"));
    State state{};
    state[kMeshAdvance] = system.mesh_advance_at_section(section.advance_with_error);
    state[kPinionSpeed] = section.pinion_speed;
    state[kGearSpeed] = section.gear_speed;
    const Instant now = system.evaluate(state, 0, ContactMode::kDriveLoaded, 0.0, 0.0);
    EXPECT_EQ(now.friction_power > 0.0, now.mesh_force > 0.0);
    EXPECT_NEAR(now.pinion_friction_torque * section.pinion_speed +
                    now.gear_friction_torque * section.gear_speed,
                -now.friction_power, 1e-12 * now.friction_power);
  }
}

class WorkedOrbit : public testing::TestWithParam<std::string> {
 protected:
  const json& worked() const { return find("orbits", GetParam()); }
  double vehicle_speed() const {
    return worked().at("speed_kilometres_per_hour").get<double>() / 3.6;
  }

  void expect_measures(const MeshCycle& cycle) const {
    const json& expected = worked().at("expected");
    struct Leaf {
      const char* name;
      double value;
      double tolerance;
    };
    const std::vector<Leaf> leaves = {
        {"T_s", cycle.input_torque, kOrbitTolerance},
        {"In_rms", cycle.rms_inefficiency, kOrbitTolerance},
        {"In_energy", cycle.energy_mean_inefficiency, kOrbitTolerance},
        {"dte_min", cycle.transmission_error.minimum, kExtremeTolerance},
        {"dte_mean", cycle.transmission_error.mean, kOrbitTolerance},
        {"dte_max", cycle.transmission_error.maximum, kExtremeTolerance},
        {"Tfp_min", cycle.pinion_friction_torque.minimum, kExtremeTolerance},
        {"Tfp_mean", cycle.pinion_friction_torque.mean, kOrbitTolerance},
        {"Tfp_max", cycle.pinion_friction_torque.maximum, kExtremeTolerance},
        {"T_c_max", cycle.maximum_temperature, kExtremeTolerance},
        {"lambda_min", cycle.minimum_film_parameter, kExtremeTolerance},
        {"pmax", cycle.maximum_pressure, kExtremeTolerance},
    };
    EXPECT_EQ(leaves.size(), expected.size());
    for (const Leaf& leaf : leaves) {
      EXPECT_TRUE(Matches(expected.at(leaf.name), leaf.value, leaf.tolerance)) << leaf.name;
    }
    EXPECT_NEAR(cycle.vehicle_speed / vehicle_speed(), 1.0, kOrbitTolerance);
  }

  void expect_section_state(const SectionState& state) const {
    const json& expected = worked().at("section_state");
    EXPECT_TRUE(Matches(expected.at("d_phi_sp"), state.pinion_shaft_twist, kOrbitTolerance));
    EXPECT_TRUE(Matches(expected.at("d_phi_gw"), state.gear_shaft_twist, kOrbitTolerance));
    EXPECT_TRUE(Matches(expected.at("w_s"), state.pinion_shaft_speed, kOrbitTolerance));
    EXPECT_TRUE(Matches(expected.at("w_p"), state.pinion_speed, kOrbitTolerance));
    EXPECT_TRUE(Matches(expected.at("w_g"), state.gear_speed, kOrbitTolerance));
    EXPECT_TRUE(Matches(expected.at("w_w"), state.gear_shaft_speed, kOrbitTolerance));
    EXPECT_TRUE(Matches(expected.at("y"), state.advance_with_error, kOrbitTolerance));
  }
};

TEST_P(WorkedOrbit, OneCycleReturnsToTheSectionState) {
  const GearPairSystem system = make_system(FrictionArms::kTabulated);
  const MeshCycle cycle = integrate_mesh_cycle(
      system, read_section_state(worked().at("section_state")), worked().at("expected").at("T_s"),
      resistive_torque(system.vehicle(), vehicle_speed()));
  expect_measures(cycle);
  expect_section_state(cycle.end);
}

TEST_P(WorkedOrbit, ShootingFindsItFromAPerturbedStart) {
  const GearPairSystem system = make_system(FrictionArms::kTabulated);
  SectionState start = read_section_state(worked().at("section_state"));
  start.pinion_shaft_twist *= 1.01;
  start.gear_shaft_twist *= 0.99;
  start.advance_with_error *= 1.01;
  // A common factor: one per cent between pinion and gear would be a violent impact.
  start.pinion_shaft_speed *= 1.01;
  start.pinion_speed *= 1.01;
  start.gear_speed *= 1.01;
  start.gear_shaft_speed *= 1.01;
  const double input_torque = 0.99 * worked().at("expected").at("T_s").get<double>();
  const Orbit orbit = find_periodic_orbit(system, start, input_torque, vehicle_speed());
  EXPECT_TRUE(orbit.converged) << "mismatch " << orbit.mismatch;
  expect_measures(orbit.cycle);
  expect_section_state(orbit.start);
  RecordProperty("integrated_cycles", orbit.integrated_cycles);
}

INSTANTIATE_TEST_SUITE_P(All, WorkedOrbit, testing::ValuesIn(names_of("orbits")), test_name);

TEST(Orbit, QuasiStaticStartFindsTheUpSweepBranchWhereTwoCoexist) {
  const GearPairSystem system = make_system(FrictionArms::kTabulated);
  const double vehicle_speed = 67.5 / 3.6;
  const Orbit orbit =
      find_periodic_orbit(system, quasi_static_start(system, vehicle_speed),
                          frictionless_input_torque(system, vehicle_speed), vehicle_speed);
  EXPECT_TRUE(orbit.converged) << "mismatch " << orbit.mismatch;
  EXPECT_TRUE(Matches(find("orbits", "L1_67.5_up").at("expected").at("In_rms"),
                      orbit.cycle.rms_inefficiency, kOrbitTolerance));
}

TEST(Orbit, MarchingLeadsIntoVibroImpact) {
  const GearPairSystem system = make_system(FrictionArms::kTabulated);
  const double vehicle_speed = 72.5 / 3.6;
  OrbitOptions options;
  options.marching_cycles = 50;
  const Orbit orbit = find_periodic_orbit(system, quasi_static_start(system, vehicle_speed),
                                          1.01 * frictionless_input_torque(system, vehicle_speed),
                                          vehicle_speed, options);
  EXPECT_TRUE(orbit.converged) << "mismatch " << orbit.mismatch;
  EXPECT_TRUE(Matches(find("orbits", "L1_72.5_up").at("expected").at("In_rms"),
                      orbit.cycle.rms_inefficiency, kOrbitTolerance));
  EXPECT_GT(orbit.cycle.separated_fraction, 0.3);
}

// Arms from the actual sliding direction instead of the tabulated ones: how far the orbits move.
TEST(Orbit, VelocityArmsMoveTheOrbitByLittle) {
  const GearPairSystem system = make_system(FrictionArms::kFromVelocities);
  const json& worked = find("orbits", "L1_67.5_down");
  const Orbit orbit = find_periodic_orbit(system, read_section_state(worked.at("section_state")),
                                          worked.at("expected").at("T_s"), 67.5 / 3.6);
  EXPECT_TRUE(orbit.converged) << "mismatch " << orbit.mismatch;
  EXPECT_TRUE(Matches(worked.at("expected").at("In_rms"), orbit.cycle.rms_inefficiency, 3e-5));
  EXPECT_TRUE(
      Matches(worked.at("expected").at("In_energy"), orbit.cycle.energy_mean_inefficiency, 1e-5));
  EXPECT_FALSE(
      Matches(worked.at("expected").at("Tfp_mean"), orbit.cycle.pinion_friction_torque.mean, 1e-5));
  EXPECT_TRUE(
      Matches(worked.at("expected").at("Tfp_mean"), orbit.cycle.pinion_friction_torque.mean, 1e-4));
}

}  // namespace
}  // namespace tribodyn::yardstick
