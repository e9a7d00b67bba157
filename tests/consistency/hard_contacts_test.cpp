#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/contact/hertz.h"
#include "core/lubricant/viscosity.h"
#include "tests/consistency/plain_contact.h"
#include "tests/support/refusal_reason.h"
#include "yardstick_friction.h"

// Contacts at the edges of the laws: each has a closed form, a brute-force value, the value of the
// independent implementation, or a refusal by name.
namespace tribodyn {
namespace {

using plain::difference;
using std::numbers::pi;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

yardstick::ContactFriction yardstick_of(const ContactCase& c) {
  const Lubricant& l = c.lubricant;
  yardstick::FrictionOptions options;
  options.isothermal = c.options.isothermal;
  options.newtonian = c.options.newtonian;
  options.houpert_pressure_index =
      c.options.pressure_viscosity_index == PressureViscosityIndex::kHoupert;
  options.elliptic_integral_hertz = c.options.hertz_solution == HertzSolution::kExact;
  options.inlet_shear_heating = c.options.inlet_shear_heating;
  options.quadrature_nodes = 64;
  return {
      {l.vogel_viscosity_prefactor, l.vogel_temperature_coefficient, l.vogel_reference_temperature,
       l.pressure_viscosity_coefficient, l.pressure_viscosity_temperature, l.relaxation_time,
       l.havriliak_negami_alpha, l.havriliak_negami_beta, l.rheology_reference_temperature,
       l.limiting_shear_stress_at_zero_pressure, l.limiting_shear_stress_coefficient,
       l.density_temperature_slope, l.density_at_zero_kelvin, l.thermal_conductivity},
      {c.solid.youngs_modulus, c.solid.poissons_ratio, c.solid.thermal_conductivity,
       c.solid.density, c.solid.specific_heat_capacity},
      {c.roughness.asperity_density, c.roughness.asperity_radius, c.roughness.composite_rms_height,
       c.boundary.tribofilm_shear_strength, c.boundary.asperity_friction_coefficient},
      c.sump_temperature,
      c.inlet_temperature_rise,
      options};
}

/// Eqs 38 and 39 for a stress.
double temperature_of(const ContactCase& c, const ContactSolution& s, double stress) {
  const double friction = (s.contact_area - s.asperity_area) * stress + s.boundary_friction;
  return c.inlet_temperature() +
         s.sliding_speed *
             (s.thermal_resistance_1 * s.heat_partition * friction +
              stress * s.central_film_thickness / (8 * c.lubricant.thermal_conductivity));
}

/// The stress and temperature of a solution against the plain equations.
void expect_equilibrium(const ContactCase& c, const ContactSolution& s) {
  EXPECT_EQ(s.status, ContactStatus::kOk) << contact_status_name(s.status);
  const plain::Shear shear{c, s.pressure_viscosity_index, s.shear_rate, s.contact_temperature};
  const double stress = plain::mean_stress(shear, s.maximum_pressure);
  EXPECT_LE(difference(s.mean_shear_stress, stress), 1e-12);
  const double hot = c.options.isothermal ? c.inlet_temperature() : temperature_of(c, s, stress);
  EXPECT_LE(difference(s.contact_temperature, hot), 1e-12);
}

/// Solves and compares every figure with the independent implementation. That one looks for
/// T_c up to the limiting stress, which must not heat the film out of the density law.
ContactSolution expect_yardstick(const ContactCase& c, double tolerance = 1e-9) {
  const ContactSolution s = c.solve();
  expect_equilibrium(c, s);
  const double limit = c.lubricant.limiting_shear_stress_at_zero_pressure +
                       c.lubricant.limiting_shear_stress_coefficient * s.maximum_pressure * 2 / 3;
  const double end = -c.lubricant.density_at_zero_kelvin / c.lubricant.density_temperature_slope;
  const bool in_reach =
      c.options.newtonian || c.options.isothermal || temperature_of(c, s, limit) < end;
  if (!in_reach) return s;
  const ContactConditions& k = c.conditions;
  const yardstick::ContactResult y =
      yardstick_of(c).evaluate({k.load, k.radius_x, k.radius_y, k.velocity_1_x, k.velocity_1_y,
                                k.velocity_2_x, k.velocity_2_y});
  const auto expect = [tolerance](const char* name, double ours, double theirs) {
    EXPECT_LE(difference(ours, theirs), tolerance) << name << " " << ours << " " << theirs;
  };
  expect("W_EHL", s.film_load, y.film_load);
  expect("W_asp", s.asperity_load, y.asperity_load);
  expect("A_EHL", s.contact_area, y.film_area);
  expect("A_asp", s.asperity_area, y.asperity_area);
  expect("p_max", s.maximum_pressure, y.maximum_pressure);
  expect("R_e", s.entrainment_radius, y.entrainment_radius);
  expect("h_cen", s.central_film_thickness, y.central_film_thickness);
  expect("T_c", s.contact_temperature, y.temperature);
  expect("l_p", s.active_length_1, y.pinion_active_length);
  expect("a_h", s.heat_partition, y.heat_partition);
  expect("tau_bar", s.mean_shear_stress, y.mean_shear_stress);
  expect("F_v", s.viscous_friction, y.viscous_friction);
  expect("F_b", s.boundary_friction, y.boundary_friction);
  expect("F_fr", s.friction, y.friction);
  expect("q", s.heat_rate, y.heat_rate);
  EXPECT_EQ(s.limiting_stress_switches, y.limiting_stress_switches);
  return s;
}

TEST(HardContacts, VanishingLoad) {
  for (const double load : {1e-3, 1e-6, 1e-9, 1e-15, 1e-30, 1e-60, 1e-100, 1e-200, 1e-300}) {
    SCOPED_TRACE(load);
    ContactCase c;
    c.conditions.load = load;
    const ContactSolution s = expect_yardstick(c);
    EXPECT_LT(s.asperity_load, 1e-3 * load);
    if (load > 1e-20) continue;
    // Ambient pressure all over: eqs 23 and 39 with eta_0 alone.
    const double thinning =
        plain::log_shear_thinning(c.lubricant, s.shear_rate, s.contact_temperature);
    const double eta =
        std::exp(plain::log_viscosity(c.lubricant, s.contact_temperature) - thinning);
    EXPECT_LE(difference(s.mean_shear_stress, eta * s.shear_rate), 1e-7);
    const double slide = s.sliding_speed;
    EXPECT_NEAR(s.contact_temperature - c.inlet_temperature(),
                eta * slide * slide / (8 * c.lubricant.thermal_conductivity), 1e-6);
  }
}

TEST(HardContacts, InletShearHeatingThinsFilmsFromColdToHot) {
  for (const double sump : {253.15, 313.15, 363.15}) {
    for (const double load : {50.0, 2000.0}) {
      SCOPED_TRACE(std::to_string(sump) + " K, " + std::to_string(load) + " N");
      ContactCase c;
      c.sump_temperature = sump;
      c.conditions.load = load;
      const double without = c.solve().central_film_thickness;
      c.options.inlet_shear_heating = true;
      EXPECT_LT(expect_yardstick(c).central_film_thickness, without);
    }
  }
}

TEST(HardContacts, NoLoadAndLiftedFlanksHaveNoFriction) {
  ContactCase c;
  for (const double load : {0.0, -0.0, -1e-300, -2000.0}) {
    c.conditions.load = load;
    const ContactSolution s = c.solve();
    EXPECT_EQ(s.status, ContactStatus::kNoLoad);
    EXPECT_EQ(s.friction, 0);
    EXPECT_EQ(s.heat_rate, 0);
  }
}

TEST(HardContacts, PureRollingLeavesTheAsperities) {
  ContactCase c;
  c.conditions = {2000, 0.015, 0.3, 5, 1, 5, 1};
  const ContactSolution s = c.solve();
  ASSERT_EQ(s.status, ContactStatus::kOk);
  EXPECT_EQ(s.sliding_speed, 0);
  EXPECT_EQ(s.shear_rate, 0);
  EXPECT_EQ(s.mean_shear_stress, 0);
  EXPECT_EQ(s.viscous_friction, 0);
  EXPECT_EQ(s.heat_rate, 0);
  EXPECT_EQ(s.contact_temperature, c.inlet_temperature());
  EXPECT_EQ(s.friction, 2e6 * s.asperity_area + 0.17 * s.asperity_load);
  EXPECT_GT(s.friction, 0);
  EXPECT_DOUBLE_EQ(s.heat_partition, 0.5);
}

TEST(HardContacts, SlowSlidingTendsToPureRolling) {
  ContactCase c;
  c.conditions = {2000, 0.015, 0.3, 5, 1, 5, 1};
  const ContactSolution rolling = c.solve();
  for (const double creep : {1e-3, 1e-6, 1e-9, 1e-12}) {
    c.conditions.velocity_2_x = 5 - creep;
    const ContactSolution s = c.solve();
    ASSERT_EQ(s.status, ContactStatus::kOk);
    // tau is at most the ambient stress times exp(alpha p): linear in the creep.
    EXPECT_LT(s.friction - rolling.boundary_friction, 2e5 * creep);
    EXPECT_GT(s.viscous_friction, 0);
  }
}

/// W_EHL + C W_EHL^(2/3) = W for surfaces without a film: a cubic in W_EHL^(1/3).
double film_load_without_film(const ContactCase& c, double asperity_load_per_unit_film_load) {
  double root = std::cbrt(c.conditions.load);
  for (int i = 0; i < 100; ++i) {
    const double f = root * root * (root + asperity_load_per_unit_film_load) - c.conditions.load;
    root -= f / (root * (3 * root + 2 * asperity_load_per_unit_film_load));
  }
  return root * root * root;
}

TEST(HardContacts, ZeroEntrainmentSitsOnTheLimitingStress) {
  for (const double load : {1e-6, 1.0, 2000.0, 2e4}) {
    SCOPED_TRACE(load);
    ContactCase c;
    c.conditions = {load, 0.015, 0.3, 3, 2, -3, -2};
    const ContactSolution s = c.solve();
    ASSERT_EQ(s.status, ContactStatus::kOk);
    EXPECT_EQ(s.central_film_thickness, 0);
    EXPECT_EQ(s.film_ratio, 0);
    EXPECT_EQ(s.shear_rate, kInfinity);
    // F_5/2(0) = 2^(5/2) Gamma(7/4)/(2 sqrt pi), F_2(0) = 1/2.
    const double f = std::pow(2, 1.25) * std::tgamma(1.75) / (2 * std::sqrt(pi));
    const double modulus = 206e9 / (1 - 0.09), product = 0.04 * 0.04, ratio = 0.3 / 0.015;
    const double k = 1.0339 * std::pow(ratio, 0.636), eps = 1.0003 + 0.5968 / ratio;
    const double radius = 0.015 * 0.3 / 0.315;
    const double unit_area = pi * std::cbrt(6 * k * k * eps * radius / (pi * modulus)) *
                             std::cbrt(6 * eps * radius / (pi * k * modulus));
    const double per_unit =
        8 * std::sqrt(2.0) / 15 * pi * unit_area * product * std::sqrt(0.01) * modulus * f;
    EXPECT_LE(difference(s.film_load, film_load_without_film(c, per_unit)), 1e-12);
    EXPECT_LE(difference(s.asperity_area, pi * pi * s.contact_area * product / 2), 1e-14);
    const double limit = 4e6 + 0.029 * s.maximum_pressure * 2 / 3;
    EXPECT_LE(difference(s.mean_shear_stress, limit), 1e-14);
    EXPECT_EQ(s.limiting_stress_area_share, 1);
    const double flash = s.thermal_resistance_1 * s.heat_partition * s.heat_rate;
    EXPECT_LE(difference(s.contact_temperature, c.inlet_temperature() + flash), 1e-14);

    c.options.no_limiting_shear_stress = true;
    EXPECT_EQ(c.solve().status, ContactStatus::kRefusedUnboundedShear);
    c.conditions.velocity_2_x = c.conditions.velocity_2_y = 0;
    c.conditions.velocity_1_x = c.conditions.velocity_1_y = 0;
    EXPECT_EQ(c.solve().status, ContactStatus::kOk);  // no film, but no sliding either
  }
}

TEST(HardContacts, NearlyZeroEntrainmentTendsToIt) {
  ContactCase c;
  c.conditions = {2000, 0.015, 0.3, 3, 0, -3, 0};
  const ContactSolution still = c.solve();
  for (const double speed : {1e-6, 1e-12, 1e-50, 1e-300}) {
    c.conditions.velocity_2_x = -3 + speed;
    c.conditions.velocity_1_x = 3;
    c.conditions.velocity_1_y = speed;
    const ContactSolution s = c.solve();
    ASSERT_EQ(s.status, ContactStatus::kOk);
    if (speed < 1e-9) {
      EXPECT_LE(difference(s.friction, still.friction), 1e-3);
    }
    if (speed < 1e-40) {
      EXPECT_LE(difference(s.friction, still.friction), 1e-12);
    }
  }
}

TEST(HardContacts, SurfaceAtRestTakesNoHeat) {
  ContactCase c;
  c.conditions = {2000, 0.015, 0.3, 5, 1, 0, 0};
  const ContactSolution gear = c.solve();
  ASSERT_EQ(gear.status, ContactStatus::kOk);
  EXPECT_EQ(gear.thermal_resistance_2, kInfinity);
  EXPECT_DOUBLE_EQ(gear.heat_partition, 1);
  EXPECT_LE(difference(gear.flash_temperature_rise, gear.thermal_resistance_1 * gear.heat_rate),
            1e-14);

  c.conditions = {2000, 0.015, 0.3, 0, 0, 5, 1};
  const ContactSolution pinion = c.solve();
  ASSERT_EQ(pinion.status, ContactStatus::kOk);
  EXPECT_EQ(pinion.thermal_resistance_1, kInfinity);
  EXPECT_EQ(pinion.heat_partition, 0);
  // The limit of R_fp a_h: through the film into the gear.
  EXPECT_LE(
      difference(pinion.flash_temperature_rise,
                 (pinion.thermal_resistance_2 + pinion.film_thermal_resistance) * pinion.heat_rate),
      1e-14);
  // and it is the limit of a slow pinion.
  c.conditions.velocity_1_x = 1e-20;
  EXPECT_LE(difference(c.solve().friction, pinion.friction), 1e-8);
}

TEST(HardContacts, BothSurfacesAtRest) {
  ContactCase c;
  c.conditions = {2000, 0.015, 0.3, 0, 0, 0, 0};
  const ContactSolution s = c.solve();
  ASSERT_EQ(s.status, ContactStatus::kOk);
  EXPECT_EQ(s.central_film_thickness, 0);
  EXPECT_EQ(s.viscous_friction, 0);
  EXPECT_EQ(s.heat_rate, 0);
  EXPECT_EQ(s.flash_temperature_rise, 0);
  EXPECT_EQ(s.contact_temperature, c.inlet_temperature());
  EXPECT_EQ(s.friction, 2e6 * s.asperity_area + 0.17 * s.asperity_load);
  EXPECT_EQ(s.heat_partition, 0.5);
}

TEST(HardContacts, WideToNeedleLikeEllipses) {
  for (double ratio = 0.4; ratio <= 1000; ratio *= 1.5) {
    SCOPED_TRACE(ratio);
    ContactCase c;
    c.conditions.radius_y = ratio * c.conditions.radius_x;
    expect_yardstick(c);
    c.options.hertz_solution = HertzSolution::kExact;
    // std::comp_ellint loses digits at a modulus near 1.
    expect_yardstick(c, ratio < 50 ? 1e-9 : 1e-8);
  }
}

TEST(HardContacts, FilmRatioFromNothingToAHundredThousand) {
  bool vanished = false;
  for (double height = 1e-3; height > 1e-12; height /= 1.7) {
    SCOPED_TRACE(height);
    ContactCase c;
    c.roughness.composite_rms_height = height;
    c.roughness.asperity_density = 0.04 / (height * c.roughness.asperity_radius);
    const ContactSolution s = expect_yardstick(c);
    if (s.film_ratio > 39) {
      vanished = true;
      EXPECT_EQ(s.film_load, c.conditions.load);
      EXPECT_EQ(s.asperity_load, 0);
      EXPECT_EQ(s.asperity_area, 0);
      EXPECT_EQ(s.boundary_friction, 0);
    }
  }
  EXPECT_TRUE(vanished);
}

TEST(HardContacts, AsperitiesThatFillTheFootprintLeaveNoViscousArea) {
  ContactCase c;
  c.roughness.asperity_density *= 12;  // eta beta sigma = 0.48: A_asp > A_EHL at no film
  c.conditions = {2000, 0.015, 0.3, 1e-4, 0, 0, 0};
  const ContactSolution s = c.solve();
  ASSERT_EQ(s.status, ContactStatus::kOk);
  ASSERT_GT(s.asperity_area, s.contact_area);
  EXPECT_EQ(s.viscous_friction, 0);
  EXPECT_EQ(s.friction, s.boundary_friction);
}

TEST(HardContacts, FilmFarThinnerThanTheRoughness) {
  for (const double speed : {1.0, 1e-2, 1e-4, 1e-6}) {
    SCOPED_TRACE(speed);
    ContactCase c;
    c.roughness = {5e8, 15e-6, 5e-6};
    c.conditions.velocity_1_x = 1.2 * speed;
    c.conditions.velocity_2_x = 0.8 * speed;
    c.conditions.velocity_1_y = c.conditions.velocity_2_y = 0.1 * speed;
    const ContactSolution s = expect_yardstick(c);
    EXPECT_LT(s.film_ratio, 0.2);
    EXPECT_GT(s.asperity_load, 0.15 * c.conditions.load);
  }
}

TEST(HardContacts, ArcticToScorchingSumps) {
  for (const int fluid : {1, 2, 3}) {
    for (double celsius = -70; celsius <= 200; celsius += 15) {
      SCOPED_TRACE(std::to_string(fluid) + " at " + std::to_string(celsius));
      ContactCase c;
      c.lubricant = reference_lubricant(fluid);
      c.sump_temperature = celsius + 273.15;
      expect_yardstick(c);
      c.options.isothermal = true;
      expect_yardstick(c);
    }
  }
}

TEST(HardContacts, ThreeHundredMetresPerSecondOfSliding) {
  for (const double load : {1.0, 100.0, 5000.0}) {
    SCOPED_TRACE(load);
    ContactCase c;
    c.conditions = {load, 0.015, 0.3, 40, 200, 40, -100};
    const ContactSolution s = expect_yardstick(c);
    EXPECT_DOUBLE_EQ(s.sliding_speed, 300);
    c.options.newtonian = true;
    expect_yardstick(c);
  }
}

TEST(HardContacts, OilTooThickToFlowIsRefused) {
  ContactCase c;
  c.lubricant.vogel_reference_temperature = 230;
  c.sump_temperature = 233.15;
  for (const bool yasutomi : {false, true}) {
    if (yasutomi) c.lubricant.pressure_viscosity_law = PressureViscosityLaw::kImprovedYasutomi;
    c.lubricant.law_parameters = {1e16, 210.6, 0.455e-9, 7.606e-9, -0.4193};
    c.inlet_temperature_rise = 20;
    EXPECT_EQ(refusal_reason([&] { c.model(); }), "VISCOSITY_OUT_OF_RANGE");
    // Up to the limit, and no further.
    const double highest = 230 + 944.8 / std::log(1e6 / 1.55e-4);
    c.inlet_temperature_rise = highest - c.sump_temperature - 1e-6;
    EXPECT_EQ(refusal_reason([&] { c.model(); }), "VISCOSITY_OUT_OF_RANGE");
    c.inlet_temperature_rise += 2e-6;
    EXPECT_EQ(refusal_reason([&] { c.model(); }), "none");
  }
}

TEST(HardContacts, ParametersThatNoFluidSurfaceOrMaterialHasAreRefused) {
  const auto reason = [](void (*change)(ContactCase&)) {
    ContactCase c;
    change(c);
    return refusal_of([&] { c.model(); });
  };
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [&](const char* field, void (*change)(ContactCase&)) {
    const std::string text = reason(change);
    EXPECT_EQ(text.substr(0, text.find(':')), "PARAMETER_OUT_OF_RANGE") << field;
    EXPECT_NE(text.find(field), std::string::npos) << text;
  };
  expect("relaxation_time", [](ContactCase& c) { c.lubricant.relaxation_time = kNoNumber; });
  expect("thermal_conductivity", [](ContactCase& c) { c.lubricant.thermal_conductivity = -1; });
  expect("vogel_temperature_coefficient",
         [](ContactCase& c) { c.lubricant.vogel_temperature_coefficient = -1; });
  expect("limiting_shear_stress_coefficient",
         [](ContactCase& c) { c.lubricant.limiting_shear_stress_coefficient = -0.03; });
  expect("density_temperature_slope",
         [](ContactCase& c) { c.lubricant.density_temperature_slope = kInfinity; });
  expect("expansivity_exponent", [](ContactCase& c) {
    c.lubricant.pressure_viscosity_law = PressureViscosityLaw::kImprovedYasutomi;
    c.lubricant.law_parameters = {1e12, 210.6, 0.455e-9, 7.606e-9, 0.4193};
  });
  expect("poissons_ratio", [](ContactCase& c) { c.solid.poissons_ratio = 0.51; });
  expect("youngs_modulus", [](ContactCase& c) { c.solid.youngs_modulus = 0; });
  expect("composite_rms_height", [](ContactCase& c) { c.roughness.composite_rms_height = 0; });
  expect("tribofilm_shear_strength",
         [](ContactCase& c) { c.boundary.tribofilm_shear_strength = -1; });
  expect("sump_temperature", [](ContactCase& c) { c.sump_temperature = kNoNumber; });
  // Both of them.
  const auto both = [](ContactCase& c) {
    c.lubricant.relaxation_time = -1;
    c.lubricant.havriliak_negami_beta = -1;
  };
  expect("relaxation_time", both);
  expect("havriliak_negami_beta", both);
}

TEST(HardContacts, BelowTheVogelTemperatureThereIsNoViscosity) {
  const auto reason = [](const ContactCase& c) {
    try {
      return std::string(contact_status_name(c.solve().status));
    } catch (const Refusal& refusal) {
      EXPECT_NE(std::string(refusal.what()).find("Vogel"), std::string::npos) << refusal.what();
      return refusal.reason();
    }
  };
  ContactCase c;
  const double vogel = c.lubricant.vogel_reference_temperature;
  c.inlet_temperature_rise = 0;
  for (const double below : {0.0, 1e-9, 1.0, 100.0, 1000.0}) {
    c.sump_temperature = vogel - below;
    EXPECT_EQ(reason(c), "BELOW_VOGEL_TEMPERATURE");
  }
  c.sump_temperature = std::nextafter(vogel, 1e3);  // e^(1e16) Pa s
  EXPECT_EQ(reason(c), "VISCOSITY_OUT_OF_RANGE");
  c.sump_temperature = vogel + 60;
  EXPECT_EQ(reason(c), "OK");
  c.lubricant.pressure_viscosity_temperature = vogel;
  EXPECT_EQ(reason(c), "BELOW_VOGEL_TEMPERATURE");
  c.lubricant.pressure_viscosity_temperature = 313.15;
  c.lubricant.rheology_reference_temperature = vogel - 1;
  EXPECT_EQ(reason(c), "BELOW_VOGEL_TEMPERATURE");
  c.options.newtonian = true;  // eq 25 is not needed
  EXPECT_EQ(reason(c), "OK");
}

// Arguments that overflowed a product, or never came back, although each of them is finite.
TEST(HardContacts, NumbersBeyondAnyGeometry) {
  ContactCase c;
  c.conditions.radius_x = c.conditions.radius_y = std::numeric_limits<double>::max();
  EXPECT_NE(c.solve().status, ContactStatus::kRefusedNotFinite);
  c = {};
  // W/(E' R_e^2) is infinite, its logarithm is not: a film of 1e-80 m, which nothing cools.
  c.conditions.radius_y = 1e-170;
  EXPECT_EQ(c.solve().status, ContactStatus::kRefusedNoTemperature);
  for (double ratio = 1e25; ratio < 1e300; ratio *= 1e5) {
    const HertzFit needle = exact_ellipticity(1e-150, 1e-150 * ratio);
    const double log_k = std::log(needle.ellipticity);
    EXPECT_NEAR(2 * log_k - std::log(std::log(4.0) + log_k - 1), std::log(ratio),
                1e-13 * std::log(ratio));
    EXPECT_DOUBLE_EQ(needle.second_integral, 1);
  }
}

TEST(HardContacts, ImpossibleGeometryIsRefusedByName) {
  ContactCase c;
  for (const double radius : {0.0, -0.015}) {
    c.conditions.radius_x = radius;
    EXPECT_EQ(c.solve().status, ContactStatus::kRefusedRadius);
  }
  c = {};
  c.options.hertz_load = HertzLoad::kTotalLoad;
  c.roughness.asperity_density *= 10;
  c.conditions = {2000, 0.015, 0.3, 3, 0, -3, 0};
  EXPECT_EQ(c.solve().status, ContactStatus::kRefusedNoLoadSharing);
}

}  // namespace
}  // namespace tribodyn
