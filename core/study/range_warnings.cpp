#include "core/study/range_warnings.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/number_text.h"
#include "core/study/figure_limits.h"
#include "core/study/operating_target.h"
#include "core/study/range_sentences.h"

namespace tribodyn {
namespace {

RangeFigures figures_of_scene(PreparedScene& prepared, double mean_pinion_speed,
                              double maximum_pressure) {
  const FlankContactModel& model = prepared.contacts().model();
  const FlankExtremes& extremes = prepared.gear_set().extremes();
  RangeFigures out;
  out.inlet_viscosity = model.inlet_viscosity();
  out.radius_ratio = extremes.radius_ratio;
  out.maximum_pressure = maximum_pressure;
  if (maximum_pressure > 0) {
    const double square = mean_pinion_speed * mean_pinion_speed;
    out.inlet_heating_factor = model.inlet_heating_factor(
        square * extremes.entrainment_squared, square * extremes.sliding_squared, maximum_pressure);
  }
  return out;
}

std::string radius_ratio_sentence(double ratio, const ModelOptions& options) {
  constexpr double kLargestFitted = 100;
  if (options.hertz_solution != HertzSolution::kSimplified || !(ratio > kLargestFitted)) return {};
  return "the ratio of a contact's radii reaches " + number_text(ratio, kRangeDigits) +
         "; the fits of eqs 21 and 22 hold from 1 to 100 (exact_hertz has no such limit)";
}

std::string not_settled_sentence(const RangeFigures& r) {
  return "no period of 1 to 4 mesh cycles settled within " + std::to_string(r.mesh_cycles) +
         " mesh cycles: the figures are averages over " + std::to_string(r.recorded_mesh_cycles) +
         " recorded cycles, " +
         (r.estimated_relative_error ? "with a probability of 95 % to within " +
                                           number_text(100 * *r.estimated_relative_error, 2) + " %"
                                     : "too few to estimate their error");
}

std::string quasi_static_sentence(const RangeFigures& r) {
  return r.estimated_relative_error
             ? "no dynamics: with the grid's error the figures are estimated to be within " +
                   number_text(100 * *r.estimated_relative_error, 2) + " % of the full model's"
             : "no dynamics, and their effect cannot be told: flanks may part, or the mesh "
               "resonates; the inefficiency can be 10 to 45 % low";
}

}  // namespace

RangeFigures range_figures(PreparedScene& prepared, const PointResult& r) {
  RangeFigures out = figures_of_scene(prepared, r.mean_pinion_speed, r.maximum_pressure.maximum);
  out.film_ratio = r.film_ratio.minimum;
  out.film_thickness = r.central_film_thickness.mean;
  out.contact_temperature = r.contact_temperature.maximum;
  out.limiting_stress_area_share = r.limiting_stress_area_share;
  out.settled = r.settled;
  out.period_in_mesh_cycles = r.period_in_mesh_cycles;
  out.mesh_cycles = r.statistics.mesh_cycles;
  out.recorded_mesh_cycles = r.recorded_mesh_cycles;
  out.estimated_relative_error = r.estimated_relative_error;
  out.model = r.model;
  return out;
}

RangeFigures range_figures(PreparedScene& prepared, const PeriodicOrbit& orbit, PointModel model,
                           double mean_pinion_speed) {
  const SolvedContacts& contacts = *orbit.contacts;
  const auto count = static_cast<std::ptrdiff_t>(contacts.size());
  const double* const pressure = contacts.column(&ContactFigures::maximum_pressure);
  RangeFigures out = figures_of_scene(
      prepared, mean_pinion_speed, count > 0 ? *std::max_element(pressure, pressure + count) : 0);
  const double* const film_ratio = contacts.column(&ContactFigures::film_ratio);
  const double* const film = contacts.column(&ContactFigures::central_film_thickness);
  const double* const temperature = contacts.column(&ContactFigures::contact_temperature);
  const double* const limited = contacts.column(&ContactFigures::limiting_stress_area_share);
  // Contacts under a hundredth of the greatest load count as little as in a result.
  const double least_pressure = 0.215 * out.maximum_pressure;
  double load = 0, limited_load = 0, film_load = 0;  // loads go with the cube of the pressure
  for (std::ptrdiff_t n = 0; n < count; ++n) {
    if (!(pressure[n] >= least_pressure)) continue;
    const double weight = pressure[n] * pressure[n] * pressure[n];
    load += weight;
    limited_load += weight * limited[n];
    out.film_ratio = out.film_ratio > 0 ? std::min(out.film_ratio, film_ratio[n]) : film_ratio[n];
    film_load += weight * film[n];
    out.contact_temperature = std::max(out.contact_temperature, temperature[n]);
  }
  if (load > 0) {
    out.limiting_stress_area_share = limited_load / load;
    out.film_thickness = film_load / load;
  }
  out.period_in_mesh_cycles = orbit.period;
  out.estimated_relative_error = known_error(orbit.estimated_error);
  out.model = model;
  return out;
}

RangeFigures range_figures(const ContactSolution& contact, double inlet_heating_factor) {
  RangeFigures out;
  out.maximum_pressure = contact.maximum_pressure;
  out.film_ratio = contact.film_ratio;
  out.film_thickness = contact.central_film_thickness;
  out.contact_temperature = contact.contact_temperature;
  out.friction_coefficient = contact.friction_coefficient;
  out.limiting_stress_area_share = contact.limiting_stress_area_share;
  out.inlet_heating_factor = inlet_heating_factor;
  out.inlet_viscosity = contact.inlet_viscosity;
  return out;
}

std::vector<RangeWarning> range_warnings(const RangeGrounds& grounds, const RangeFigures& r,
                                         bool with_sentences) {
  std::vector<RangeWarning> out;
  const auto warn = [&](const char* code, double excess, std::string sentence) {
    if (sentence.empty()) return;
    if (!with_sentences) sentence.clear();
    out.push_back({code, std::move(sentence), excess});
  };
  const double inlet = grounds.inlet_temperature;
  const double hottest = std::max(inlet, r.contact_temperature);
  const bool is_loaded = r.maximum_pressure > 0;
  if (const auto& measured = grounds.fluid.viscosity_measured) {
    warn("VISCOSITY_TEMPERATURE", std::max(measured->lowest - inlet, hottest - measured->highest),
         viscosity_sentence(grounds.fluid, inlet, hottest));
  }
  warn("VISCOSITY_RANGE", std::abs(std::log(r.inlet_viscosity)),
       viscosity_range_sentence(r.inlet_viscosity));
  warn("RADIUS_RATIO", r.radius_ratio, radius_ratio_sentence(r.radius_ratio, grounds.options));
  if (is_loaded) {
    warn("PRESSURE",
         std::max(kLowestComparedPressure / r.maximum_pressure,
                  r.maximum_pressure / kHighestComparedPressure),
         pressure_sentence(r.maximum_pressure));
    warn("NO_LUBRICATED_CONTACT", r.friction_coefficient + r.contact_temperature / kHottestFilm,
         no_lubricated_contact_sentence(r.friction_coefficient, r.contact_temperature));
    warn("THICK_FILM", r.film_thickness, thick_film_sentence(r.film_thickness));
    warn("INLET_HEATING_LEFT_OUT", -r.inlet_heating_factor,
         inlet_heating_sentence(r.inlet_heating_factor, grounds.options));
    warn("STARVATION", -r.inlet_heating_factor,
         starvation_sentence(r.inlet_heating_factor, grounds.options));
  }
  if (grounds.roughness.asperity_density > 0) {
    if (is_loaded) warn("FILM_RATIO", -r.film_ratio, film_ratio_sentence(r.film_ratio));
    warn("ROUGHNESS_PRODUCT", 0, roughness_product_sentence(grounds.roughness));
  }
  warn("LIMITING_STRESS", r.limiting_stress_area_share,
       limiting_stress_sentence(grounds.fluid, r.limiting_stress_area_share));
  if (!r.settled) {
    warn("NOT_SETTLED", r.estimated_relative_error.value_or(1), not_settled_sentence(r));
  } else if (r.period_in_mesh_cycles > 1) {
    warn("PERIOD", r.period_in_mesh_cycles,
         "the response repeats after " + std::to_string(r.period_in_mesh_cycles) + " mesh cycles");
  }
  if (r.model == PointModel::kQuasiStatic) {
    warn("QUASI_STATIC", r.estimated_relative_error.value_or(1), quasi_static_sentence(r));
  }
  warn("ISOTHERMAL", 0, isothermal_sentence(grounds.options));
  return out;
}

std::vector<RangeWarning> range_warnings(const Scene& scene, const RangeFigures& figures,
                                         bool with_sentences) {
  return range_warnings({scene.fluid_grounds, scene.options, scene.roughness,
                         scene.sump_temperature + scene.inlet_temperature_rise},
                        figures, with_sentences);
}

void keep_furthest(const std::vector<RangeWarning>& warnings, std::vector<RangeWarning>& kept) {
  for (const RangeWarning& each : warnings) {
    const auto found = std::find_if(kept.begin(), kept.end(), [&each](const RangeWarning& other) {
      return other.code == each.code;
    });
    if (found == kept.end()) {
      kept.push_back(each);
    } else if (each.excess > found->excess) {
      *found = each;
    }
  }
}

}  // namespace tribodyn
