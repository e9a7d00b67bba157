#include "core/contact/flank_contact.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <string>

#include "core/celsius.h"
#include "core/contact/film_thickness.h"
#include "core/contact/hertz.h"
#include "core/contact/load_sharing.h"
#include "core/contact/mean_shear_stress.h"
#include "core/contact/thermal_equilibrium.h"
#include "core/contact/thermal_network.h"
#include "core/lubricant/rheology.h"
#include "core/lubricant/viscosity.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

bool all_finite(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// False where a law overflowed: only shear rate and thermal resistances of solids may be infinite.
bool representable(const ContactSolution& s) {
  return !std::isnan(s.shear_rate + s.pinion_thermal_resistance + s.gear_thermal_resistance) &&
         all_finite({s.film_load,
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
                     s.pinion_active_length,
                     s.gear_active_length,
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

std::string celsius(double kelvin) {
  return std::to_string(kelvin - kZeroCelsius) + " degrees Celsius";
}

}  // namespace

FlankContactModel::FlankContactModel(const Lubricant& lubricant, const Solid& solid,
                                     const Roughness& roughness, const BoundaryFriction& boundary,
                                     double bath_temperature, double inlet_temperature_rise,
                                     const ModelOptions& options)
    : lubricant_(lubricant),
      solid_(solid),
      roughness_(roughness),
      boundary_(boundary),
      options_(options),
      inlet_temperature_(bath_temperature + inlet_temperature_rise) {
  const double vogel = lubricant.vogel_reference_temperature;
  const auto above_vogel = [&](double temperature, const char* what) {
    if (temperature > vogel) return;
    throw Refusal("BELOW_VOGEL_TEMPERATURE",
                  std::string(what) + " of " + celsius(temperature) +
                      " is not above the Vogel reference temperature of " + celsius(vogel) +
                      ": eq 34 has no viscosity there");
  };
  above_vogel(inlet_temperature_, "an inlet temperature");
  above_vogel(lubricant.pressure_viscosity_temperature, "a pressure-viscosity temperature");
  time_temperature_reference_ = 0;
  if (!options.newtonian) {
    above_vogel(lubricant.rheology_reference_temperature, "a rheology reference temperature");
    if (!(density(lubricant, lubricant.rheology_reference_temperature) > 0) ||
        !(density(lubricant, inlet_temperature_) > 0)) {
      throw Refusal(
          "DENSITY_NOT_POSITIVE",
          "the density law is not positive at the rheology reference or inlet temperature");
    }
    time_temperature_reference_ = time_temperature_reference(lubricant);
  }

  const bool houpert = options.as_published.eq31_32_logarithm ||
                       options.pressure_viscosity_index == PressureViscosityIndex::kHoupert;
  const double factor_where_measured =
      roelands_factor(log_ambient_viscosity(lubricant, lubricant.pressure_viscosity_temperature),
                      options.as_published);
  const double log_inlet_viscosity = log_ambient_viscosity(lubricant, inlet_temperature_);
  const double inlet_factor = roelands_factor(log_inlet_viscosity, options.as_published);
  if (!(factor_where_measured > 0) || !(inlet_factor > 0)) {
    throw Refusal("ROELANDS_FACTOR",
                  "ln eta_0 + 9.67 of eq 31 is not positive: the fluid is too thin for the law");
  }
  if (houpert) {
    roelands_index_ =
        index_from_houpert(factor_where_measured, lubricant.pressure_viscosity_coefficient);
    inlet_pressure_viscosity_coefficient_ =
        roelands_index_ * kRoelandsPressureCoefficient * inlet_factor;
  } else {
    roelands_index_ = index_from_reciprocal_asymptotic(factor_where_measured,
                                                       lubricant.pressure_viscosity_coefficient);
    inlet_pressure_viscosity_coefficient_ =
        reciprocal_asymptotic_coefficient(inlet_factor, roelands_index_);
  }
  inlet_viscosity_ = std::exp(log_inlet_viscosity);
  reduced_modulus_ = tribodyn::reduced_modulus(solid.youngs_modulus, solid.poissons_ratio);
  const double product =
      roughness.asperity_density * roughness.asperity_radius * roughness.composite_rms_height;
  asperity_load_factor_ = 8 * std::numbers::sqrt2 / 15 * std::numbers::pi * product * product *
                          std::sqrt(roughness.composite_rms_height / roughness.asperity_radius) *
                          reduced_modulus_;
  asperity_area_factor_ = std::numbers::pi * std::numbers::pi * product * product;
  can_limit_ = !options.no_limiting_shear_stress;
}

ContactSolution FlankContactModel::solve(const ContactConditions& conditions) const {
  ContactSolution out;
  const auto refuse = [&out](ContactStatus status) {
    out = ContactSolution{};
    out.status = status;
    return out;
  };
  const ContactConditions& k = conditions;
  if (!all_finite({k.load, k.radius_x, k.radius_y, k.pinion_velocity_x, k.pinion_velocity_y,
                   k.gear_velocity_x, k.gear_velocity_y})) {
    return refuse(ContactStatus::kRefusedNotFinite);
  }
  if (!(k.load > 0)) return refuse(ContactStatus::kNoLoad);
  if (!(k.radius_x > 0 && k.radius_y > 0)) return refuse(ContactStatus::kRefusedRadius);

  ContactStatus status = share_load(conditions, out);
  if (status == ContactStatus::kOk) status = heat(conditions, out);
  if (status == ContactStatus::kOk && !representable(out)) status = ContactStatus::kRefusedOverflow;
  if (status != ContactStatus::kOk) return refuse(status);
  out.status = status;
  return out;
}

/// Eqs 12-22 and 41: how film and asperities share the load, and the ellipse and film that follow.
ContactStatus FlankContactModel::share_load(const ContactConditions& k,
                                            ContactSolution& out) const {
  const double mean_x = 0.5 * (k.pinion_velocity_x + k.gear_velocity_x);
  const double mean_y = 0.5 * (k.pinion_velocity_y + k.gear_velocity_y);
  out.entrainment_speed = std::hypot(mean_x, mean_y);
  double cosine = 1, sine = 0;
  if (out.entrainment_speed > 0) {
    cosine = mean_x / out.entrainment_speed;
    sine = mean_y / out.entrainment_speed;
    out.entrainment_angle = std::atan2(mean_y, mean_x);
    if (options_.as_published.eq17_atan) {
      out.entrainment_angle = std::atan(mean_y / mean_x);
      cosine = std::cos(out.entrainment_angle);
      sine = std::sin(out.entrainment_angle);
      out.entrainment_speed = mean_x * cosine + mean_y * sine;
      if (out.entrainment_speed < 0) return ContactStatus::kRefusedNegativeEntrainment;
    }
  }
  out.entrainment_radius = 1 / (cosine * cosine / k.radius_x + sine * sine / k.radius_y);
  out.side_leakage_radius = 1 / (sine * sine / k.radius_x + cosine * cosine / k.radius_y);
  out.inlet_viscosity = inlet_viscosity_;
  out.inlet_pressure_viscosity_coefficient = inlet_pressure_viscosity_coefficient_;
  out.pressure_viscosity_index = roelands_index_;
  out.reduced_modulus = reduced_modulus_;

  const HertzFit fit = options_.hertz_solution == HertzSolution::kExact
                           ? exact_ellipticity(k.radius_x, k.radius_y)
                           : simplified_ellipticity(k.radius_x, k.radius_y, options_.as_published);
  const UnitLoadEllipse unit =
      unit_load_ellipse(fit, k.radius_x, k.radius_y, reduced_modulus_, options_.as_published);
  const FilmConditions film{out.entrainment_radius, out.side_leakage_radius,
                            inlet_viscosity_,       inlet_pressure_viscosity_coefficient_,
                            out.entrainment_speed,  reduced_modulus_};
  const double film_under_all = chittenden_dowson_central_film(film, k.load);
  if (!std::isfinite(film_under_all) || (film_under_all == 0 && out.entrainment_speed > 0)) {
    return ContactStatus::kRefusedOverflow;
  }
  const bool from_total = options_.hertz_load == HertzLoad::kTotalLoad;
  const EllipseAxes axes_under_all = ellipse_axes(unit, k.load);
  const LoadSharing sharing{k.load, film_under_all / roughness_.composite_rms_height,
                            asperity_load_factor_ * std::numbers::pi * axes_under_all.semi_major *
                                axes_under_all.semi_minor,
                            from_total, options_.as_published.eq43_44_polynomials};
  const SharedLoad shared = solve_load_sharing(sharing);
  if (!shared.found) return ContactStatus::kRefusedNoLoadSharing;
  if (!std::isnormal(shared.film_load)) return ContactStatus::kRefusedOverflow;

  out.film_load = shared.film_load;
  const EllipseAxes axes = from_total ? axes_under_all : ellipse_axes(unit, out.film_load);
  out.semi_major_axis = axes.semi_major;
  out.semi_minor_axis = axes.semi_minor;
  out.maximum_pressure = axes.maximum_pressure;
  out.contact_area = std::numbers::pi * axes.semi_major * axes.semi_minor;
  out.central_film_thickness =
      out.entrainment_speed > 0 ? chittenden_dowson_central_film(film, out.film_load) : 0;
  out.film_ratio = out.central_film_thickness / roughness_.composite_rms_height;
  const AsperityFunctions functions = options_.as_published.eq43_44_polynomials
                                          ? asperity_functions_as_published(out.film_ratio)
                                          : asperity_functions(out.film_ratio);
  out.asperity_load = asperity_load_factor_ * out.contact_area * functions.f5_2;
  out.asperity_area = asperity_area_factor_ * out.contact_area * functions.f2;
  return ContactStatus::kOk;
}

/// Eqs 18, 23-28 and 35-40: shear, friction and the temperature that they settle at.
ContactStatus FlankContactModel::heat(const ContactConditions& k, ContactSolution& out) const {
  const double slide =
      std::hypot(k.pinion_velocity_x - k.gear_velocity_x, k.pinion_velocity_y - k.gear_velocity_y);
  out.sliding_speed = slide;
  out.shear_rate = slide > 0 ? slide / out.central_film_thickness : 0;
  if (!options_.no_boundary_friction) {
    out.boundary_friction = boundary_.tribofilm_shear_strength * out.asperity_area +
                            boundary_.asperity_friction_coefficient * out.asperity_load;
  }

  const bool major_along_y = k.radius_y >= k.radius_x;
  const double semi_x = major_along_y ? out.semi_minor_axis : out.semi_major_axis;
  const double semi_y = major_along_y ? out.semi_major_axis : out.semi_minor_axis;
  const double diffusivity =
      solid_.thermal_conductivity / (solid_.density * solid_.specific_heat_capacity);
  out.pinion_active_length =
      active_length(semi_x, semi_y, k.pinion_velocity_x, k.pinion_velocity_y);
  out.gear_active_length = active_length(semi_x, semi_y, k.gear_velocity_x, k.gear_velocity_y);
  const ThermalNetwork network{
      out.central_film_thickness / (2 * lubricant_.thermal_conductivity * out.contact_area),
      moving_source_conductance(out.contact_area, solid_.thermal_conductivity, diffusivity,
                                out.pinion_active_length,
                                std::hypot(k.pinion_velocity_x, k.pinion_velocity_y)),
      moving_source_conductance(out.contact_area, solid_.thermal_conductivity, diffusivity,
                                out.gear_active_length,
                                std::hypot(k.gear_velocity_x, k.gear_velocity_y))};
  out.film_thermal_resistance = network.film_resistance;
  out.pinion_thermal_resistance = 1 / network.pinion_conductance;
  out.gear_thermal_resistance = 1 / network.gear_conductance;
  out.heat_partition = network.heat_partition();

  const double viscous_area = std::max(0.0, out.contact_area - out.asperity_area);
  out.contact_temperature = inlet_temperature_;
  if (slide > 0) {
    const bool limited = can_limit_;
    const bool no_stress = limited && lubricant_.limiting_shear_stress_at_zero_pressure == 0 &&
                           lubricant_.limiting_shear_stress_coefficient == 0;
    if (std::isinf(out.shear_rate) && !limited) return ContactStatus::kRefusedUnboundedShear;

    const double flash_per_watt = network.flash_resistance();
    const double from_boundary = flash_per_watt * out.boundary_friction * slide;
    const double per_stress =
        flash_per_watt * viscous_area * slide +
        oil_temperature_rise(slide, 1, out.central_film_thickness, lubricant_.thermal_conductivity);
    if (no_stress) {
      if (!options_.isothermal) out.contact_temperature += from_boundary;
      out.limiting_stress_area_share = 1;
      out.limiting_stress_at_centre = true;
    } else if (std::isinf(out.shear_rate)) {
      // No film under sliding: all of the area sits on tau_L, whose mean over eq 19 is closed form.
      out.mean_shear_stress = limiting_shear_stress(lubricant_, out.maximum_pressure * 2 / 3);
      out.limiting_stress_area_share = 1;
      out.limiting_stress_at_centre = true;
      if (!options_.isothermal) {
        out.contact_temperature += from_boundary + per_stress * out.mean_shear_stress;
      }
    } else {
      const ShearedFilm film{&lubricant_,
                             options_.as_published,
                             out.maximum_pressure,
                             roelands_index_,
                             std::log(out.shear_rate),
                             time_temperature_reference_,
                             options_.newtonian,
                             limited};
      const ThermalEquilibrium equilibrium = solve_thermal_equilibrium(
          film, inlet_temperature_ + (options_.isothermal ? 0 : from_boundary),
          options_.isothermal ? 0 : per_stress);
      if (equilibrium.roots == 0) return ContactStatus::kRefusedNoTemperature;
      out.contact_temperature = equilibrium.temperature;
      out.thermal_roots = equilibrium.roots;
      out.mean_shear_stress = std::exp(equilibrium.stress.log_value);
      out.limiting_stress_area_share = equilibrium.stress.limited_area_share;
      out.limiting_stress_switches = equilibrium.stress.switches;
      out.limiting_stress_at_centre = equilibrium.stress.limited_at_centre;
    }
    if (!options_.isothermal) {
      out.oil_temperature_rise =
          oil_temperature_rise(slide, out.mean_shear_stress, out.central_film_thickness,
                               lubricant_.thermal_conductivity);
    }
  }
  out.viscous_friction = viscous_area * out.mean_shear_stress;
  out.friction = out.viscous_friction + out.boundary_friction;
  out.heat_rate = out.friction * slide;
  if (!options_.isothermal && slide > 0) {
    out.flash_temperature_rise = network.flash_resistance() * out.heat_rate;
  }
  out.friction_coefficient = out.friction / k.load;
  return ContactStatus::kOk;
}

const char* contact_status_name(ContactStatus status) {
  switch (status) {
    case ContactStatus::kOk:
      return "OK";
    case ContactStatus::kNoLoad:
      return "NO_LOAD";
    case ContactStatus::kRefusedNotFinite:
      return "NOT_FINITE";
    case ContactStatus::kRefusedRadius:
      return "RADIUS_NOT_POSITIVE";
    case ContactStatus::kRefusedNegativeEntrainment:
      return "NEGATIVE_ENTRAINMENT";
    case ContactStatus::kRefusedUnboundedShear:
      return "UNBOUNDED_SHEAR";
    case ContactStatus::kRefusedNoLoadSharing:
      return "NO_LOAD_SHARING";
    case ContactStatus::kRefusedNoTemperature:
      return "NO_CONTACT_TEMPERATURE";
    case ContactStatus::kRefusedOverflow:
      return "OVERFLOW";
  }
  return "UNKNOWN";
}

const char* contact_status_sentence(ContactStatus status) {
  switch (status) {
    case ContactStatus::kOk:
      return "solved";
    case ContactStatus::kNoLoad:
      return "no load, no contact: every force is zero";
    case ContactStatus::kRefusedNotFinite:
      return "an input of the contact is not a finite number";
    case ContactStatus::kRefusedRadius:
      return "a radius of curvature is not positive";
    case ContactStatus::kRefusedNegativeEntrainment:
      return "eq 17 as published gives a negative entrainment speed for backward entrainment";
    case ContactStatus::kRefusedUnboundedShear:
      return "sliding without a film and without a limiting shear stress has no finite stress";
    case ContactStatus::kRefusedNoLoadSharing:
      return "no film load balances asperities and film (eq 41): eqs 43 and 44 as published pull "
             "where the film ratio is above 2.2, as under the light loads of impacts, and an "
             "ellipse from the total load can leave no root";
    case ContactStatus::kRefusedNoTemperature:
      return "no contact temperature balances heat and conduction while the density law of eq 26 "
             "is positive";
    case ContactStatus::kRefusedOverflow:
      return "a law left the range of double precision";
  }
  return "unknown";
}

}  // namespace tribodyn
