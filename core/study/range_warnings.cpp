#include "core/study/range_warnings.h"

#include <algorithm>
#include <string>

#include "core/number_text.h"
#include "core/study/range_sentences.h"

namespace tribodyn {
namespace {

/// Largest ratio of the principal radii of flanks that carry load.
double largest_radius_ratio(const ToothContactTables& tables) {
  double largest = 0;
  for (std::size_t k = 0; k < tables.load_share.size(); ++k) {
    for (std::size_t i = 0; i < tables.load_share[k].size(); ++i) {
      if (!(tables.load_share[k][i] > 0)) continue;
      const double x = tables.radius_x[k][i], y = tables.radius_y[k][i];
      largest = std::max(largest, std::max(x, y) / std::min(x, y));
    }
  }
  return largest;
}

}  // namespace

std::vector<RangeWarning> range_warnings(const Scene& scene, const PointResult& r) {
  std::vector<RangeWarning> out;
  const auto warn = [&out](const char* code, const std::string& sentence) {
    if (!sentence.empty()) out.push_back({code, sentence});
  };
  const double inlet = scene.sump_temperature + scene.inlet_temperature_rise;
  const double highest_temperature = std::max(inlet, r.contact_temperature.maximum);
  warn("VISCOSITY_TEMPERATURE",
       viscosity_sentence(scene.fluid_grounds, inlet, highest_temperature));
  if (r.maximum_pressure.maximum > 0) {
    warn("PRESSURE", pressure_sentence(r.maximum_pressure.maximum));
  }
  if (scene.options.hertz_solution == HertzSolution::kSimplified) {
    constexpr double kLargestFitted = 100;
    const double ratio = largest_radius_ratio(scene.gear_set.tables);
    if (ratio > kLargestFitted) {
      warn("RADIUS_RATIO", "the ratio of a contact's radii reaches " +
                               number_text(ratio, kRangeDigits) +
                               "; the fits of eqs 21 and 22 hold from 1 to 100 (exact_hertz has no "
                               "such limit)");
    }
  }
  if (r.film_ratio.maximum > 0) warn("FILM_RATIO", film_ratio_sentence(r.film_ratio.minimum));
  warn("ROUGHNESS_PRODUCT", roughness_product_sentence(scene.roughness));
  warn("LIMITING_STRESS",
       limiting_stress_sentence(scene.fluid_grounds, r.limiting_stress_area_share));
  warn("COLD_INLET", cold_inlet_sentence(inlet, scene.options));
  if (!r.settled) {
    warn("NOT_SETTLED", "no period of 1 to 4 mesh cycles settled within " +
                            std::to_string(r.statistics.mesh_cycles) +
                            " mesh cycles: the figures are averages over " +
                            std::to_string(r.recorded_mesh_cycles) + " recorded cycles, " +
                            (r.estimated_relative_error
                                 ? "with a probability of 95 % to within " +
                                       number_text(100 * *r.estimated_relative_error, 2) + " %"
                                 : "too few to estimate their error"));
  } else if (r.period_in_mesh_cycles > 1) {
    warn("PERIOD",
         "the response repeats after " + std::to_string(r.period_in_mesh_cycles) + " mesh cycles");
  }
  if (r.model == PointModel::kQuasiStatic) {
    warn("QUASI_STATIC",
         r.estimated_relative_error
             ? "no dynamics: with the grid's error the figures are estimated to be within " +
                   number_text(100 * *r.estimated_relative_error, 2) + " % of the full model's"
             : "no dynamics, and their effect cannot be told: flanks may part, or the mesh "
               "resonates; the inefficiency can be 10 to 45 % low");
  }
  warn("ISOTHERMAL", isothermal_sentence(scene.options));
  return out;
}

}  // namespace tribodyn
