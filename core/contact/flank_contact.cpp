#include "core/contact/flank_contact.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <numbers>

#include "core/contact/contact_equations.h"
#include "core/contact/thermal_equilibrium.h"
#include "core/lubricant/lubricant_parameters.h"
#include "core/lubricant/viscosity.h"
#include "core/parameter_check.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

bool all_finite(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// False where a law overflowed: only shear rate and thermal resistances of solids may be infinite.
bool representable(const ContactSolution& s) {
  return !std::isnan(s.shear_rate + s.thermal_resistance_1 + s.thermal_resistance_2) &&
         all_finite({s.film_load,
                     s.ellipse_load,
                     s.asperity_load,
                     s.contact_area,
                     s.asperity_area,
                     s.semi_major_axis,
                     s.semi_minor_axis,
                     s.maximum_pressure,
                     s.entrainment_angle,
                     s.entrainment_radius,
                     s.side_leakage_radius,
                     s.entrainment_speed,
                     s.sliding_speed,
                     s.central_film_thickness,
                     s.film_ratio,
                     s.contact_temperature,
                     s.flash_temperature_rise,
                     s.oil_temperature_rise,
                     s.active_length_1,
                     s.active_length_2,
                     s.film_thermal_resistance,
                     s.heat_partition,
                     s.mean_shear_stress,
                     s.viscous_friction,
                     s.boundary_friction,
                     s.friction,
                     s.heat_rate,
                     s.friction_coefficient,
                     s.limiting_stress_area_share});
}

void set_ratios(const ContactConditions& k, ContactFigures& figures) {
  figures.friction_coefficient = figures.friction / k.load;
  const SpecificSliding sliding = specific_sliding(k);
  figures.specific_sliding_1 = sliding.surface_1;
  figures.specific_sliding_2 = sliding.surface_2;
}

}  // namespace

FlankContactModel::FlankContactModel(const Lubricant& lubricant, const SolidPair& solids,
                                     const Roughness& roughness, const BoundaryFriction& boundary,
                                     double bath_temperature, double inlet_temperature_rise,
                                     const ModelOptions& options)
    : parameters_{lubricant, solids, roughness, boundary, bath_temperature, inlet_temperature_rise},
      options_(options) {
  check(lubricant);
  check(solids.body_1);
  check(solids.body_2);
  check(roughness);
  check(boundary);
  ParameterCheck temperatures;
  temperatures.expect("sump_temperature", bath_temperature, "K", Bound::kFinite);
  temperatures.expect("inlet_temperature_rise", inlet_temperature_rise, "K", Bound::kFinite);
  temperatures.conclude();
  const double inlet_temperature = bath_temperature + inlet_temperature_rise;
  check_above_vogel(lubricant, inlet_temperature, "an inlet temperature");
  check_ambient_viscosity(lubricant, inlet_temperature, "an inlet temperature");
  const bool roelands = lubricant.pressure_viscosity_law == PressureViscosityLaw::kRoelands;
  const double where_measured = lubricant.pressure_viscosity_temperature;
  if (roelands) check_above_vogel(lubricant, where_measured, "a pressure-viscosity temperature");
  if (!options.newtonian) {
    const double reference = lubricant.rheology_reference_temperature;
    check_above_vogel(lubricant, reference, "a rheology reference temperature");
    if (!(density(lubricant, reference) > 0) || !(density(lubricant, inlet_temperature) > 0)) {
      throw Refusal(
          "DENSITY_NOT_POSITIVE",
          "the density law is not positive at the rheology reference or inlet temperature");
    }
  }
  if (roelands) check_pressure_growth(lubricant, where_measured, options.as_published);
  check_pressure_growth(lubricant, inlet_temperature, options.as_published);
  constants_ = contact_constants(parameters_, options, index_from_reciprocal_asymptotic);
}

ContactSolution FlankContactModel::solve(const ContactConditions& conditions) const {
  ContactSolution out;
  const auto refuse = [&out](ContactStatus status) {
    out = ContactSolution{};
    out.status = status;
    return out;
  };
  const ContactConditions& k = conditions;
  if (!all_finite({k.load, k.radius_x, k.radius_y, k.velocity_1_x, k.velocity_1_y, k.velocity_2_x,
                   k.velocity_2_y})) {
    return refuse(ContactStatus::kRefusedNotFinite);
  }
  if (!(k.load > 0)) return refuse(ContactStatus::kNoLoad);
  if (!(k.radius_x > 0 && k.radius_y > 0)) return refuse(ContactStatus::kRefusedRadius);

  SharedContact<double> shared;
  ContactStatus status = share_load(conditions, shared, out);
  if (status == ContactStatus::kOk) status = heat(conditions, shared, out);
  if (status == ContactStatus::kOk && !representable(out)) status = ContactStatus::kRefusedOverflow;
  if (status != ContactStatus::kOk) return refuse(status);
  out.status = status;
  return out;
}

/// How film and asperities share the load, and the ellipse and film that follow.
ContactStatus FlankContactModel::share_load(const ContactConditions& k,
                                            SharedContact<double>& shared,
                                            ContactSolution& out) const {
  const double mean_x = 0.5 * (k.velocity_1_x + k.velocity_2_x);
  const double mean_y = 0.5 * (k.velocity_1_y + k.velocity_2_y);
  const LoadedContact<double> loaded = loaded_contact(parameters_, constants_, options_, k);
  if (loaded.entrainment_speed > 0) {
    const bool misprinted = options_.as_published.eq17_atan;
    if (misprinted && mean_x < 0) return ContactStatus::kRefusedNegativeEntrainment;
    out.entrainment_angle = misprinted ? std::atan(mean_y / mean_x) : std::atan2(mean_y, mean_x);
  }
  out.entrainment_speed = loaded.entrainment_speed;
  out.entrainment_radius = loaded.entrainment_radius;
  out.side_leakage_radius = loaded.side_leakage_radius;
  out.inlet_viscosity = std::exp(constants_.log_inlet_viscosity);
  out.inlet_pressure_viscosity_coefficient = constants_.pressure_viscosity_coefficient;
  out.pressure_viscosity_index = constants_.shear.index;
  out.reduced_modulus = constants_.reduced_modulus;

  if (!std::isfinite(loaded.film_thickness) ||
      (loaded.film_thickness == 0 && loaded.entrainment_speed > 0)) {
    return ContactStatus::kRefusedFilmOverflow;
  }
  const SharedLoad share = solve_load_sharing(loaded.sharing);
  if (!share.found) return ContactStatus::kRefusedNoLoadSharing;
  shared = shared_contact(parameters_, constants_, loaded, share.log_share);
  if (!std::isnormal(shared.ellipse_load)) return ContactStatus::kRefusedOverflow;

  out.film_load = shared.film_load;
  out.ellipse_load = shared.ellipse_load;
  out.semi_major_axis = shared.axes.semi_major;
  out.semi_minor_axis = shared.axes.semi_minor;
  out.maximum_pressure = shared.axes.maximum_pressure;
  out.contact_area = shared.contact_area;
  out.central_film_thickness = shared.film_thickness;
  out.film_ratio = shared.film_ratio;
  out.asperity_load = shared.asperity_load;
  out.asperity_area = shared.asperity_area;
  return ContactStatus::kOk;
}

/// Shear, friction and the temperature at which both settle.
ContactStatus FlankContactModel::heat(const ContactConditions& k,
                                      const SharedContact<double>& shared,
                                      ContactSolution& out) const {
  const HeatedContact<double> heated = heated_contact(parameters_, constants_, options_, k, shared);
  const Lubricant& oil = parameters_.lubricant;
  const double slide = heated.sliding_speed;
  out.sliding_speed = slide;
  out.shear_rate = heated.shear_rate;
  out.boundary_friction = heated.boundary_friction;
  const double semi_x = k.radius_y >= k.radius_x ? out.semi_minor_axis : out.semi_major_axis;
  const auto active_length = [&](double velocity_x, double velocity_y, double rate) {
    return rate > 0 ? std::hypot(velocity_x, velocity_y) / rate : semi_x;
  };
  out.active_length_1 = active_length(k.velocity_1_x, k.velocity_1_y, heated.rate_1);
  out.active_length_2 = active_length(k.velocity_2_x, k.velocity_2_y, heated.rate_2);
  out.film_thermal_resistance = shared.film_thickness / heated.film_conduction;
  out.thermal_resistance_1 = 1 / heated.conductance_1;
  out.thermal_resistance_2 = 1 / heated.conductance_2;
  const bool both_rest = heated.conductance_1 + heated.conductance_2 == 0;
  out.heat_partition = both_rest ? 0.5 : heated.conductance_1 * heated.flash_resistance;

  out.contact_temperature = constants_.inlet_temperature;
  if (slide > 0) {
    const bool limited = !options_.no_limiting_shear_stress;
    const bool no_stress = limited && oil.limiting_shear_stress_at_zero_pressure == 0 &&
                           oil.limiting_shear_stress_coefficient == 0;
    if (std::isinf(out.shear_rate) && !limited) return ContactStatus::kRefusedUnboundedShear;

    if (no_stress || std::isinf(out.shear_rate)) {
      // No film under sliding: all of the area sits on tau_L.
      out.mean_shear_stress = laws::mean_limiting_shear_stress(
          oil.limiting_shear_stress_at_zero_pressure, oil.limiting_shear_stress_coefficient,
          out.maximum_pressure);
      out.limiting_stress_area_share = 1;
      out.limiting_stress_at_centre = true;
      out.contact_temperature =
          heated.temperature.base + heated.temperature.gain * out.mean_shear_stress;
    } else {
      const ShearedFilm film{&constants_.shear, out.maximum_pressure, std::log(out.shear_rate),
                             limited};
      const ThermalEquilibrium equilibrium =
          solve_thermal_equilibrium(film, heated.temperature.base, heated.temperature.gain);
      if (equilibrium.roots == 0) return ContactStatus::kRefusedNoTemperature;
      out.contact_temperature = equilibrium.temperature;
      out.thermal_roots = equilibrium.roots;
      out.mean_shear_stress = std::exp(equilibrium.stress.log_value);
      out.limiting_stress_area_share = equilibrium.stress.limited_area_share;
      out.limiting_stress_switches = equilibrium.stress.switches;
      out.limiting_stress_at_centre = equilibrium.stress.limited_at_centre;
    }
  }
  out.viscous_friction = laws::viscous_friction(heated.viscous_area, out.mean_shear_stress);
  out.friction = laws::friction(out.viscous_friction, out.boundary_friction);
  out.heat_rate = out.friction * slide;
  if (!options_.isothermal && slide > 0) {
    out.oil_temperature_rise =
        out.mean_shear_stress *
        laws::oil_rise_per_stress(slide, out.central_film_thickness, oil.thermal_conductivity);
    out.flash_temperature_rise = heated.flash_resistance * out.heat_rate;
  }
  set_ratios(k, out);
  return ContactStatus::kOk;
}

void FlankContactModel::complete(const ContactConditions& k, ContactFigures& figures) const {
  set_ratios(k, figures);
  figures.entrainment_speed = std::sqrt(
      laws::entrainment_speed_squared(laws::square(0.5 * (k.velocity_1_x + k.velocity_2_x)),
                                      laws::square(0.5 * (k.velocity_1_y + k.velocity_2_y))));
  figures.flash_temperature_rise = flash_temperature_rise(
      k, figures.central_film_thickness, figures.mean_shear_stress, figures.contact_temperature);
}

double FlankContactModel::flash_temperature_rise(const ContactConditions& k, double film_thickness,
                                                 double mean_shear_stress,
                                                 double contact_temperature) const {
  if (options_.isothermal) return 0;
  const double oil_rise =
      mean_shear_stress * laws::oil_rise_per_stress(sliding_speed(k), film_thickness,
                                                    parameters_.lubricant.thermal_conductivity);
  return std::max(0.0, contact_temperature - constants_.inlet_temperature - oil_rise);
}

double FlankContactModel::inlet_heating_factor(double entrainment_squared, double sliding_squared,
                                               double maximum_pressure) const {
  if (!(entrainment_squared > 0)) return 1;
  return laws::inlet_heating_factor(constants_.log_thermal_loading, std::log(entrainment_squared),
                                    std::log(sliding_squared), maximum_pressure,
                                    constants_.reduced_modulus);
}

double FlankContactModel::log_stress_over_limit(const ContactFigures& figures) const {
  const ShearedFilm film{&constants_.shear, figures.maximum_pressure, std::log(figures.shear_rate),
                         true};
  return tribodyn::log_stress_over_limit(film, figures.contact_temperature);
}

namespace {

/// Of each ContactStatus, in its order.
struct StatusText {
  const char* name;
  const char* sentence;
};

constexpr StatusText kStatusTexts[] = {
    {"OK", "solved"},
    {"NO_LOAD", "no load, no contact: every force is zero"},
    {"NOT_FINITE", "an input of the contact is not a finite number"},
    {"RADIUS_NOT_POSITIVE", "a radius of curvature is not positive"},
    {"NEGATIVE_ENTRAINMENT",
     "eq 17 as published gives a negative entrainment speed for backward entrainment"},
    {"UNBOUNDED_SHEAR",
     "sliding without a film and without a limiting shear stress has no finite stress"},
    {"NO_LOAD_SHARING",
     "no film load balances asperities and film (eq 41): eqs 43 and 44 as published pull where the "
     "film ratio is above 2.2, as under the light loads of impacts, and an ellipse from the total "
     "load can leave no root"},
    {"NO_CONTACT_TEMPERATURE",
     "no contact temperature balances heat and conduction while the density law of eq 26 is "
     "positive"},
    {"OVERFLOW",
     "the film thickness of eq 12 left the range of double precision: check the units of load, "
     "radii, velocities and elastic moduli"},
    {"OVERFLOW",
     "pressure, heat or friction of the contact, of eqs 18 to 42, left the range of double "
     "precision: check the units of load, radii, velocities, roughness and thermal properties"},
};
static_assert(std::size(kStatusTexts) == static_cast<int>(ContactStatus::kRefusedOverflow) + 1);

const StatusText& text_of(ContactStatus status) { return kStatusTexts[static_cast<int>(status)]; }

}  // namespace

const char* contact_status_name(ContactStatus status) { return text_of(status).name; }
const char* contact_status_sentence(ContactStatus status) { return text_of(status).sentence; }

}  // namespace tribodyn
