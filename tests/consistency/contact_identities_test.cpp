#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "core/numerics/square.h"
#include "tests/consistency/plain_contact.h"
#include "yardstick_friction.h"

// The equations, each evaluated apart from the model from the film load, film, area and temperature
// that it returned, give back the rest of what it returned.
namespace tribodyn {
namespace {

using plain::difference;
using std::numbers::pi;

constexpr double kResidual = 1e-12;

/// Residual of each equation by name.
using Residuals = std::map<std::string, double>;

double asperity_function(double order, double film_ratio, const AsPublished& as_published) {
  if (!as_published.eq43_44_polynomials) return yardstick::asperity_integral(order, film_ratio);
  const double l = film_ratio;
  return order == 2 ? -0.0018 * std::pow(l, 5) + 0.0281 * std::pow(l, 4) - 0.1728 * std::pow(l, 3) +
                          0.5258 * l * l - 0.8043 * l + 0.5003
                    : -0.0046 * std::pow(l, 5) + 0.0574 * std::pow(l, 4) - 0.2958 * std::pow(l, 3) +
                          0.7844 * l * l - 1.0776 * l + 0.6167;
}

void add_film_and_load(const ContactCase& c, const ContactSolution& s, Residuals& out) {
  const ContactConditions& k = c.conditions;
  const AsPublished& misprints = c.options.as_published;
  out["W = W_EHL + W_asp"] = std::abs(k.load - s.film_load - s.asperity_load) /
                             (std::abs(s.film_load) + std::abs(s.asperity_load));
  const double modulus = c.solid.youngs_modulus / (1 - square(c.solid.poissons_ratio));
  out["eq 13 E'"] = difference(s.reduced_modulus, modulus);

  const double mean_x = (k.velocity_1_x + k.velocity_2_x) / 2;
  const double mean_y = (k.velocity_1_y + k.velocity_2_y) / 2;
  const double cosine = std::cos(s.entrainment_angle), sine = std::sin(s.entrainment_angle);
  const double speeds = std::abs(mean_x) + std::abs(mean_y);
  out["eq 17 U_eff"] = std::abs(s.entrainment_speed - (mean_x * cosine + mean_y * sine)) / speeds;
  out["eq 17 no leakage across"] = std::abs(mean_y * cosine - mean_x * sine) / speeds;
  const double along = 1 / (square(cosine) / k.radius_x + square(sine) / k.radius_y);
  const double across = 1 / (square(sine) / k.radius_x + square(cosine) / k.radius_y);
  out["eq 15 R_e"] = difference(s.entrainment_radius, along);
  out["eq 16 R_s"] = difference(s.side_leakage_radius, across);

  const double eta = std::exp(plain::log_viscosity(c.lubricant, c.inlet_temperature()));
  out["eq 34 eta_0"] = difference(s.inlet_viscosity, eta);
  const double speed_number = eta * s.entrainment_speed / (modulus * along);
  const double material_number = s.inlet_pressure_viscosity_coefficient * modulus;
  const double load_number = s.film_load / (modulus * square(along));
  out["eq 12 h_cen"] =
      difference(s.central_film_thickness,
                 4.31 * along * std::pow(speed_number, 0.68) * std::pow(material_number, 0.49) *
                     std::pow(load_number, -0.073) *
                     (1 - std::exp(-1.23 * std::pow(across / along, 2.0 / 3))));
  out["lambda_s"] =
      difference(s.film_ratio, s.central_film_thickness / c.roughness.composite_rms_height);

  const double product = square(c.roughness.asperity_density * c.roughness.asperity_radius *
                                c.roughness.composite_rms_height);
  // The polynomials cancel near their roots: their largest term is the scale.
  const double term =
      misprints.eq43_44_polynomials ? std::max(0.5, 0.0018 * std::pow(s.film_ratio, 5)) : 0;
  const auto scaled = [&](double found, double factor, double function) {
    const double scale = factor * std::max(std::abs(function), term);
    return std::abs(found - factor * function) /
           std::max(scale, std::numeric_limits<double>::min());
  };
  out["eq 41 W_asp"] = scaled(
      s.asperity_load,
      8 * std::sqrt(2.0) / 15 * pi * s.contact_area * product *
          std::sqrt(c.roughness.composite_rms_height / c.roughness.asperity_radius) * modulus,
      asperity_function(2.5, s.film_ratio, misprints));
  out["eq 42 A_asp"] = scaled(s.asperity_area, pi * pi * s.contact_area * product,
                              asperity_function(2, s.film_ratio, misprints));
}

void add_ellipse(const ContactCase& c, const ContactSolution& s, Residuals& out) {
  const ContactConditions& k = c.conditions;
  const AsPublished& misprints = c.options.as_published;
  const double load = c.options.hertz_load == HertzLoad::kTotalLoad ? k.load : s.film_load;
  const double ratio = std::max(k.radius_x, k.radius_y) / std::min(k.radius_x, k.radius_y);
  const double radius = k.radius_x * k.radius_y / (k.radius_x + k.radius_y);
  double ellipticity = 1.0339 * std::pow(ratio, 0.636);
  double integral = 1.0003 + 0.5968 * (misprints.eq22_inverted_ratio ? ratio : 1 / ratio);
  if (c.options.hertz_solution == HertzSolution::kExact) {
    // Hertz's relation for the ellipticity returned; eq 20 for the axes.
    ellipticity = s.semi_major_axis / s.semi_minor_axis;
    const double modulus = std::sqrt((1 - 1 / ellipticity) * (1 + 1 / ellipticity));
    const double first = std::comp_ellint_1(modulus);
    integral = std::comp_ellint_2(modulus);
    out["Hertz's relation"] =
        difference(square(ellipticity) * integral - first, ratio * (first - integral));
  }
  const double common = 6 * load * radius / (pi * s.reduced_modulus);
  const double power = misprints.eq20_semi_major ? 2 : 1;
  out["eq 20 a_c"] = difference(
      s.semi_major_axis, std::cbrt(common * square(ellipticity) * std::pow(integral, power)));
  out["eq 20 b_c"] = difference(s.semi_minor_axis, std::cbrt(common * integral / ellipticity));
  out["A_EHL"] = difference(s.contact_area, pi * s.semi_major_axis * s.semi_minor_axis);
  out["eq 19 p_max"] = difference(s.maximum_pressure, 3 * load / (2 * s.contact_area));
}

void add_viscosity(const ContactCase& c, const ContactSolution& s, Residuals& out) {
  const Lubricant& oil = c.lubricant;
  const AsPublished& misprints = c.options.as_published;
  const double measured = plain::roelands_factor(
      plain::log_viscosity(oil, oil.pressure_viscosity_temperature), misprints);
  const double inlet =
      plain::roelands_factor(plain::log_viscosity(oil, c.inlet_temperature()), misprints);
  const double index = s.pressure_viscosity_index;
  if (misprints.eq31_32_logarithm ||
      c.options.pressure_viscosity_index == PressureViscosityIndex::kHoupert) {
    out["eq 32 Z"] =
        difference(index, oil.pressure_viscosity_coefficient / (plain::kRoelands * measured));
    out["eq 32 alpha*(T_in)"] =
        difference(s.inlet_pressure_viscosity_coefficient, index * plain::kRoelands * inlet);
    return;
  }
  out["eq 33 Z"] =
      difference(plain::reciprocal_asymptotic(measured, index), oil.pressure_viscosity_coefficient);
  out["eq 33 alpha*(T_in)"] = difference(plain::reciprocal_asymptotic(inlet, index),
                                         s.inlet_pressure_viscosity_coefficient);
}

/// Eq 36 as printed; the angle is measured from the minor axis.
double active_length(const ContactCase& c, const ContactSolution& s, double u, double v) {
  const bool major_along_y = c.conditions.radius_y >= c.conditions.radius_x;
  const double tangent = major_along_y ? v / u : u / v;
  const double a = s.semi_major_axis, b = s.semi_minor_axis;
  return std::sqrt(square(a) * square(b) * (square(tangent) + 1) /
                   (square(a) + square(b) * square(tangent)));
}

void add_heat(const ContactCase& c, const ContactSolution& s, Residuals& out) {
  const ContactConditions& k = c.conditions;
  const double slide = std::hypot(k.velocity_1_x - k.velocity_2_x, k.velocity_1_y - k.velocity_2_y);
  out["V_s"] = difference(s.sliding_speed, slide);
  out["eq 18 shear rate"] = difference(s.shear_rate, slide / s.central_film_thickness);

  const double diffusivity =
      c.solid.thermal_conductivity / (c.solid.density * c.solid.specific_heat_capacity);
  const auto resistance = [&](double length, double u, double v) {
    return 1.06 / (s.contact_area * c.solid.thermal_conductivity) *
           std::sqrt(diffusivity * length / std::hypot(u, v));
  };
  const double l_p = active_length(c, s, k.velocity_1_x, k.velocity_1_y);
  const double l_g = active_length(c, s, k.velocity_2_x, k.velocity_2_y);
  const double film =
      s.central_film_thickness / (2 * c.lubricant.thermal_conductivity * s.contact_area);
  const double pinion = resistance(l_p, k.velocity_1_x, k.velocity_1_y);
  const double gear = resistance(l_g, k.velocity_2_x, k.velocity_2_y);
  const double partition = (gear + film) / (pinion + gear + 2 * film);
  out["eq 36 l_p"] = difference(s.active_length_1, l_p);
  out["eq 36 l_g"] = difference(s.active_length_2, l_g);
  out["eq 35 R_cf"] = difference(s.film_thermal_resistance, film);
  out["eq 35 R_fp"] = difference(s.thermal_resistance_1, pinion);
  out["eq 35 R_fg"] = difference(s.thermal_resistance_2, gear);
  out["eq 37 a_h"] = difference(s.heat_partition, partition);

  const auto stress_at = [&](double temperature) {
    const plain::Shear shear{c, s.pressure_viscosity_index, slide / s.central_film_thickness,
                             temperature};
    return plain::mean_stress(shear, s.maximum_pressure);
  };
  const double boundary = c.options.no_boundary_friction
                              ? 0
                              : c.boundary.tribofilm_shear_strength * s.asperity_area +
                                    c.boundary.asperity_friction_coefficient * s.asperity_load;
  const double stress = stress_at(s.contact_temperature);
  const double viscous = (s.contact_area - s.asperity_area) * stress;
  out["eqs 23-26, 31 tau_bar"] = difference(s.mean_shear_stress, stress);
  out["eq 27 F_v"] = difference(s.viscous_friction, viscous);
  out["eq 40 F_b"] = difference(s.boundary_friction, boundary);
  // Printed asperities may pull: the scale is that of the terms.
  out["eq 28 F_fr"] = std::abs(s.friction - (viscous + boundary)) / (viscous + std::abs(boundary));
  out["mu"] = difference(s.friction_coefficient, s.friction / k.load);
  out["q"] = difference(s.heat_rate, s.friction * slide);

  const double heats = c.options.isothermal ? 0 : 1;
  const auto flash_rise = [&](double tau) {
    return heats * pinion * partition * ((s.contact_area - s.asperity_area) * tau + boundary) *
           slide;
  };
  const auto oil_rise = [&](double tau) {
    return heats * slide * tau * s.central_film_thickness / (8 * c.lubricant.thermal_conductivity);
  };
  out["eq 39 dT_f"] =
      difference(s.flash_temperature_rise, heats * pinion * partition * s.heat_rate);
  out["eq 39 dT_oil"] = difference(s.oil_temperature_rise, oil_rise(stress));
  const auto excess = [&](double temperature, double tau) {
    return c.inlet_temperature() + flash_rise(tau) + oil_rise(tau) - temperature;
  };
  double residual = std::abs(excess(s.contact_temperature, stress)) / s.contact_temperature;
  if (residual >= kResidual) {
    // Just below the end of the density law rounding T_c alone moves eq 39 by more. There the root
    // must lie that close to T_c.
    const double colder = s.contact_temperature * (1 - kResidual / 2);
    const double hotter = s.contact_temperature * (1 + kResidual / 2);
    if (excess(colder, stress_at(colder)) > 0 && excess(hotter, stress_at(hotter)) < 0) {
      residual = kResidual / 2;
    }
  }
  out["eq 38 T_c"] = residual;

  if (!c.options.no_limiting_shear_stress) {
    const double mean_limit =
        c.lubricant.limiting_shear_stress_at_zero_pressure +
        c.lubricant.limiting_shear_stress_coefficient * s.maximum_pressure * 2 / 3;
    EXPECT_LE(s.mean_shear_stress, mean_limit * (1 + 1e-14)) << "the mean beyond the mean limit";
  }
}

Residuals residuals(const ContactCase& c, const ContactSolution& s) {
  Residuals out;
  add_film_and_load(c, s, out);
  add_ellipse(c, s, out);
  add_viscosity(c, s, out);
  add_heat(c, s, out);
  return out;
}

/// Holds the equations against random contacts after `change`.
template <class Change>
void expect_identities(const char* name, std::uint64_t stream, Change change, int states) {
  Draw draw(stream);
  SCOPED_TRACE(draw.seed());
  Residuals worst;
  int solved = 0;
  for (int i = 0; i < states; ++i) {
    SCOPED_TRACE("state " + std::to_string(i));
    ContactCase c = random_contact_case(draw);
    change(c);
    const ContactSolution s = c.solve();
    if (s.status != ContactStatus::kOk) continue;
    ++solved;
    EXPECT_EQ(s.thermal_roots, 1);
    for (const auto& [equation, residual] : residuals(c, s)) {
      EXPECT_LT(residual, kResidual) << equation;
      worst[equation] = std::max(worst[equation], residual);
    }
  }
  EXPECT_GT(solved, 0.8 * states) << "too many refusals for a test";
  std::cout << name << ": " << draw.seed() << ", " << solved << " of " << states
            << " solved, worst residuals:\n";
  for (const auto& [equation, residual] : worst) {
    if (residual > 1e-14) std::cout << "  " << equation << " " << residual << "\n";
  }
}

TEST(ContactIdentities, DefaultModel) {
  expect_identities(
      "default", 1, [](ContactCase&) {}, kRandomStates);
}

TEST(ContactIdentities, IsothermalNewtonianUnlimitedAndWithoutBoundaryFriction) {
  const int states = kRandomStates / 4;
  expect_identities(
      "isothermal", 2, [](ContactCase& c) { c.options.isothermal = true; }, states);
  expect_identities(
      "Newtonian", 3, [](ContactCase& c) { c.options.newtonian = true; }, states);
  expect_identities(
      "no boundary friction", 4, [](ContactCase& c) { c.options.no_boundary_friction = true; },
      states);
  // Without a limit an isothermal film overflows at gigapascals: let it heat.
  expect_identities(
      "no limiting stress", 5, [](ContactCase& c) { c.options.no_limiting_shear_stress = true; },
      states);
}

TEST(ContactIdentities, OtherHertzAndViscosityLaws) {
  const int states = kRandomStates / 4;
  expect_identities(
      "exact Hertz", 6, [](ContactCase& c) { c.options.hertz_solution = HertzSolution::kExact; },
      states);
  expect_identities(
      "ellipse from the total load", 7,
      [](ContactCase& c) { c.options.hertz_load = HertzLoad::kTotalLoad; }, states);
  expect_identities(
      "Houpert", 8,
      [](ContactCase& c) { c.options.pressure_viscosity_index = PressureViscosityIndex::kHoupert; },
      states);
}

TEST(ContactIdentities, MisprintedEquations) {
  const int states = kRandomStates / 4;
  const auto forward = [](ContactCase& c) {
    c.options.as_published.eq17_atan = true;
    c.conditions.velocity_1_x = std::abs(c.conditions.velocity_1_x);
    c.conditions.velocity_2_x = std::abs(c.conditions.velocity_2_x);
  };
  expect_identities("eq 17 as printed, forwards", 9, forward, states);
  expect_identities(
      "eqs 20, 22 as printed", 10,
      [](ContactCase& c) {
        c.options.as_published.eq20_semi_major = true;
        c.options.as_published.eq22_inverted_ratio = true;
      },
      states);
  expect_identities(
      "eqs 43, 44 as printed", 11,
      [](ContactCase& c) {
        c.options.as_published.eq43_44_polynomials = true;
        c.roughness.composite_rms_height *= 10;  // where the polynomials were fitted
        c.roughness.asperity_density /= 10;
      },
      states);
}

}  // namespace
}  // namespace tribodyn
