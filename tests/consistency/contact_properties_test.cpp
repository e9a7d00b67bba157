#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "tests/consistency/contact_case.h"
#include "tests/support/central_film.h"

// What must hold for every contact: directions, continuity, and an answer or a named refusal for
// whatever numbers come in. RC_PARAMS="seed=..." repeats a run.
namespace tribodyn {
namespace {

/// A random contact from RapidCheck's seed.
ContactCase any_case() {
  Draw draw(*rc::gen::arbitrary<std::uint32_t>());
  return random_contact_case(draw);
}

/// A growth factor between 1 + 1e-6 and 10.
double any_growth() { return 1 + 9 * std::pow(*rc::gen::inRange(10, 1000) / 1000.0, 3); }

ContactSolution solved(const ContactCase& c) {
  const ContactSolution s = c.solve();
  RC_PRE(s.status == ContactStatus::kOk);
  return s;
}

void speed_up(ContactConditions& k, double growth) {
  for (double* v : {&k.velocity_1_x, &k.velocity_1_y, &k.velocity_2_x, &k.velocity_2_y}) {
    *v *= growth;
  }
}

RC_GTEST_PROP(FilmProperties, RisesWithViscosityCoefficientAndSpeedFallsWithLoad, ()) {
  const ContactSolution s = solved(any_case());
  const double growth = any_growth();
  FilmConditions film{s.entrainment_radius, s.side_leakage_radius,
                      s.inlet_viscosity,    s.inlet_pressure_viscosity_coefficient,
                      s.entrainment_speed,  s.reduced_modulus};
  const double h = central_film(film, s.film_load);
  RC_ASSERT(central_film(film, s.film_load * growth) < h);
  for (double* rising :
       {&film.viscosity, &film.pressure_viscosity_coefficient, &film.entrainment_speed}) {
    const double before = *rising;
    *rising *= growth;
    RC_ASSERT(central_film(film, s.film_load) > h);
    *rising = before;
  }
}

RC_GTEST_PROP(ContactProperties, ThickerOilOrFasterEntrainmentTakesLoadOffTheAsperities, ()) {
  ContactCase c = any_case();
  const ContactSolution s = solved(c);
  ContactCase faster = c;
  speed_up(faster.conditions, any_growth());
  const ContactSolution fast = solved(faster);
  RC_ASSERT(fast.central_film_thickness > s.central_film_thickness);
  RC_ASSERT(fast.asperity_load <= s.asperity_load);
  // A lower Vogel prefactor with everything else held lets alpha*(T_in) move too: measure it there.
  c.lubricant.pressure_viscosity_temperature = c.inlet_temperature();
  const ContactSolution thin = solved(c);
  c.lubricant.vogel_viscosity_prefactor *= any_growth();
  const ContactSolution thick = solved(c);
  RC_ASSERT(thick.central_film_thickness > thin.central_film_thickness);
  RC_ASSERT(thick.asperity_load <= thin.asperity_load);
}

RC_GTEST_PROP(ContactProperties, LoadRaisesPressureAndAreasAndThinsTheFilm, ()) {
  ContactCase c = any_case();
  const ContactSolution s = solved(c);
  c.conditions.load *= any_growth();
  const ContactSolution loaded = solved(c);
  RC_ASSERT(loaded.maximum_pressure > s.maximum_pressure);
  RC_ASSERT(loaded.contact_area > s.contact_area);
  RC_ASSERT(loaded.semi_major_axis > s.semi_major_axis);
  RC_ASSERT(loaded.semi_minor_axis > s.semi_minor_axis);
  RC_ASSERT(loaded.film_load > s.film_load);
  RC_ASSERT(loaded.central_film_thickness < s.central_film_thickness);
  RC_ASSERT(loaded.asperity_load >= s.asperity_load);
  RC_ASSERT(loaded.asperity_area >= s.asperity_area);
}

RC_GTEST_PROP(ContactProperties, ContactIsNeverColderThanItsInlet, ()) {
  const ContactCase c = any_case();
  const ContactSolution s = solved(c);
  RC_ASSERT(s.contact_temperature >= c.inlet_temperature());
  RC_ASSERT(s.friction >= 0);
  RC_ASSERT(s.heat_rate >= 0);
  RC_ASSERT(s.heat_partition > 0);
  RC_ASSERT(s.heat_partition < 1);
  RC_ASSERT(s.limiting_stress_area_share >= 0);
  RC_ASSERT(s.limiting_stress_area_share <= 1);
}

RC_GTEST_PROP(ContactProperties, FrictionIsContinuousInLoad, ()) {
  ContactCase c = any_case();
  const ContactSolution s = solved(c);
  c.conditions.load *= 1 + 1e-6;
  const ContactSolution more = solved(c);
  RC_ASSERT(std::abs(more.friction - s.friction) <= 1e-5 * s.friction);
}

/// Any finite double: ordinary, zero, huge, tiny, denormal, random bits, of either sign.
double any_finite() {
  const double size = *rc::gen::oneOf(
      rc::gen::element(0.0, 1e-320, std::numeric_limits<double>::denorm_min(),
                       std::numeric_limits<double>::min(), 1e-300, 1e-200, 1e-100, 1e-30, 1e-9,
                       1e-3, 1.0, 300.0, 1e4, 1e9, 1e30, 1e100, 1e154, 1e200, 1e300,
                       std::numeric_limits<double>::max()),
      rc::gen::map(rc::gen::arbitrary<std::uint64_t>(),
                   [](std::uint64_t bits) {
                     const double v = std::abs(std::bit_cast<double>(bits));
                     return std::isfinite(v) ? v : 1.0;
                   }),
      rc::gen::map(rc::gen::inRange(-3000, 3000), [](int e) { return std::pow(10, e / 10.0); }));
  return *rc::gen::arbitrary<bool>() ? size : -size;
}

/// Replaces about one in `one_in` numbers.
void shake(const std::vector<double*>& numbers, int one_in) {
  for (double* number : numbers) {
    if (*rc::gen::inRange(0, one_in) == 0) *number = any_finite();
  }
}

std::vector<double*> numbers_of(ContactConditions& k) {
  return {&k.load,         &k.radius_x,     &k.radius_y,    &k.velocity_1_x,
          &k.velocity_1_y, &k.velocity_2_x, &k.velocity_2_y};
}

std::vector<double*> numbers_of_fluid_and_surface(ContactCase& c) {
  Lubricant& l = c.lubricant;
  return {&l.vogel_viscosity_prefactor,
          &l.vogel_temperature_coefficient,
          &l.vogel_reference_temperature,
          &l.pressure_viscosity_coefficient,
          &l.pressure_viscosity_temperature,
          &l.relaxation_time,
          &l.havriliak_negami_alpha,
          &l.havriliak_negami_beta,
          &l.rheology_reference_temperature,
          &l.limiting_shear_stress_at_zero_pressure,
          &l.limiting_shear_stress_coefficient,
          &l.thermal_conductivity,
          &l.density_at_zero_kelvin,
          &l.density_temperature_slope,
          &c.solid.youngs_modulus,
          &c.solid.poissons_ratio,
          &c.solid.thermal_conductivity,
          &c.solid.density,
          &c.solid.specific_heat_capacity,
          &c.roughness.asperity_density,
          &c.roughness.asperity_radius,
          &c.roughness.composite_rms_height,
          &c.boundary.tribofilm_shear_strength,
          &c.boundary.asperity_friction_coefficient,
          &c.sump_temperature,
          &c.inlet_temperature_rise};
}

void any_options(ModelOptions& o) {
  const auto flip = [] { return *rc::gen::inRange(0, 4) == 0; };
  o.isothermal = flip();
  o.newtonian = flip();
  o.no_limiting_shear_stress = flip();
  o.no_boundary_friction = flip();
  if (flip()) o.pressure_viscosity_index = PressureViscosityIndex::kHoupert;
  if (flip()) o.hertz_solution = HertzSolution::kExact;
  if (flip()) o.hertz_load = HertzLoad::kTotalLoad;
  o.as_published = {flip(), flip(), flip(), flip(), flip(), flip()};
}

/// Finite everywhere but where flank_contact.h documents an infinity, or refused by a name.
void assert_answer_or_refusal(const ContactSolution& s) {
  if (s.status != ContactStatus::kOk) {
    RC_ASSERT(std::string(contact_status_name(s.status)) != "UNKNOWN");
    RC_ASSERT(s.friction == 0);
    return;
  }
  const auto finite = [](const char* name, double v) {
    if (!std::isfinite(v)) RC_FAIL(std::string(name) + " is not finite");
  };
#define FINITE(field) finite(#field, s.field)
  FINITE(film_load);
  FINITE(asperity_load);
  FINITE(contact_area);
  FINITE(asperity_area);
  FINITE(semi_major_axis);
  FINITE(semi_minor_axis);
  FINITE(maximum_pressure);
  FINITE(entrainment_angle);
  FINITE(entrainment_radius);
  FINITE(side_leakage_radius);
  FINITE(entrainment_speed);
  FINITE(sliding_speed);
  FINITE(inlet_viscosity);
  FINITE(inlet_pressure_viscosity_coefficient);
  FINITE(pressure_viscosity_index);
  FINITE(reduced_modulus);
  FINITE(central_film_thickness);
  FINITE(film_ratio);
  FINITE(contact_temperature);
  FINITE(flash_temperature_rise);
  FINITE(oil_temperature_rise);
  FINITE(active_length_1);
  FINITE(active_length_2);
  FINITE(film_thermal_resistance);
  FINITE(heat_partition);
  FINITE(mean_shear_stress);
  FINITE(viscous_friction);
  FINITE(boundary_friction);
  FINITE(friction);
  FINITE(heat_rate);
  FINITE(friction_coefficient);
  FINITE(limiting_stress_area_share);
#undef FINITE
  RC_ASSERT(!std::isnan(s.shear_rate));
  RC_ASSERT(!std::isnan(s.thermal_resistance_1));
  RC_ASSERT(!std::isnan(s.thermal_resistance_2));
}

RC_GTEST_PROP(ContactFuzz, AnyFiniteConditionsGiveAnAnswerOrANamedRefusal, ()) {
  ContactCase c = any_case();
  any_options(c.options);
  std::optional<FlankContactModel> model;
  try {
    model = c.model();
  } catch (const Refusal&) {
    RC_DISCARD("the model itself is refused");
  }
  for (int i = 0; i < 8; ++i) {
    ContactConditions k = c.conditions;
    shake(numbers_of(k), *rc::gen::inRange(1, 5));
    const ContactSolution s = model->solve(k);
    RC_ASSERT(s.status != ContactStatus::kRefusedNotFinite);
    RC_ASSERT((s.status == ContactStatus::kNoLoad) == !(k.load > 0));
    assert_answer_or_refusal(s);
    if (s.status != ContactStatus::kOk || c.options.as_published.eq43_44_polynomials) continue;
    // An answer, however far out, still balances.
    const double digits = 1e-9 * k.load;
    RC_ASSERT(std::abs(s.film_load + s.asperity_load - k.load) <= digits);
    RC_ASSERT(s.contact_temperature >= model->inlet_temperature());
    RC_ASSERT(s.friction >= 0);
  }
}

RC_GTEST_PROP(ContactFuzz, NotANumberIsRefusedByName, ()) {
  ContactCase c = any_case();
  const FlankContactModel model = c.model();
  const double poison = *rc::gen::element(std::numeric_limits<double>::quiet_NaN(),
                                          std::numeric_limits<double>::infinity(),
                                          -std::numeric_limits<double>::infinity());
  *numbers_of(c.conditions).at(*rc::gen::inRange(0, 7)) = poison;
  RC_ASSERT(model.solve(c.conditions).status == ContactStatus::kRefusedNotFinite);
}

RC_GTEST_PROP(ContactFuzz, AnyFluidAndSurfaceGiveAnAnswerOrANamedRefusal, ()) {
  ContactCase c = any_case();
  any_options(c.options);
  shake(numbers_of_fluid_and_surface(c), *rc::gen::inRange(4, 30));
  if (*rc::gen::arbitrary<bool>()) shake(numbers_of(c.conditions), 4);
  try {
    assert_answer_or_refusal(c.solve());
  } catch (const Refusal& refusal) {
    RC_ASSERT(!refusal.reason().empty());
  }
}

}  // namespace
}  // namespace tribodyn
