#include "core/study/range_warnings.h"

#include <algorithm>
#include <string>

#include "core/celsius.h"
#include "core/number_text.h"
#include "core/study/figure_limits.h"
#include "core/surface/roughness_product.h"

namespace tribodyn {
namespace {

constexpr int kDigits = 3;  // a warning says where a range is left, not by how many digits

std::string short_text(double value) { return number_text(value, kDigits); }

std::string range_text(double low, double high, const char* unit) {
  return short_text(low) + " to " + short_text(high) + " " + unit;
}

/// Empty where the film stays in the range, or the range is not known.
std::string viscosity_sentence(const FluidGrounds& grounds, double inlet, double hottest) {
  if (!grounds.viscosity_measured) return {};
  const double lowest = grounds.viscosity_measured->lowest - kZeroCelsius;
  const double highest = grounds.viscosity_measured->highest - kZeroCelsius;
  // Kelvin and back leaves an error in the 14th digit.
  constexpr double kRounding = 1e-9;
  if (inlet >= lowest - kRounding && hottest <= highest + kRounding) return {};
  return "the film is at " + range_text(inlet, hottest, "C") +
         "; the viscosity of this lubricant was measured from " + range_text(lowest, highest, "C") +
         " and is extrapolated beyond";
}

std::string pressure_sentence(double gigapascals) {
  constexpr double kLowest = 1e-9 * kLowestComparedPressure;
  constexpr double kHighest = 1e-9 * kHighestComparedPressure;
  if (gigapascals >= kLowest && gigapascals <= kHighest) return {};
  return "the largest contact pressure is " + short_text(gigapascals) + " GPa, " +
         (gigapascals < kLowest ? "below" : "above") + " the " +
         range_text(kLowest, kHighest, "GPa") +
         " at which the friction model was compared with measurements (fig 5)";
}

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

std::string limiting_stress_origin(FluidGrounds::LimitingStress limiting_stress) {
  switch (limiting_stress) {
    case FluidGrounds::LimitingStress::kMeasuredAtForty:
      return "was measured at 40 C";
    case FluidGrounds::LimitingStress::kEstimated:
      return "is estimated from the class of base oil";
    case FluidGrounds::LimitingStress::kStated:
      break;
  }
  return "is as stated for this lubricant";
}

}  // namespace

std::vector<RangeWarning> range_warnings(const Scene& scene, const PointResult& r) {
  std::vector<RangeWarning> out;
  const auto warn = [&out](const char* code, const std::string& sentence) {
    if (!sentence.empty()) out.push_back({code, sentence});
  };
  const double inlet = scene.sump_temperature + scene.inlet_temperature_rise - kZeroCelsius;
  const double hottest = std::max(inlet, r.contact_temperature.maximum - kZeroCelsius);
  warn("VISCOSITY_TEMPERATURE", viscosity_sentence(scene.fluid_grounds, inlet, hottest));
  if (r.maximum_pressure.maximum > 0) {
    warn("PRESSURE", pressure_sentence(r.maximum_pressure.maximum * 1e-9));
  }
  if (scene.options.hertz_solution == HertzSolution::kSimplified) {
    constexpr double kLargestFitted = 100;
    const double ratio = largest_radius_ratio(scene.gear_set.tables);
    if (ratio > kLargestFitted) {
      warn("RADIUS_RATIO", "the ratio of a contact's radii reaches " + short_text(ratio) +
                               "; the fits of eqs 21 and 22 hold from 1 to 100 (exact_hertz has no "
                               "such limit)");
    }
  }
  if (r.film_ratio.minimum < kSparseAsperities && r.film_ratio.maximum > 0) {
    warn("FILM_RATIO", "the film ratio falls to " + short_text(r.film_ratio.minimum) +
                           "; below about " + short_text(kSparseAsperities) +
                           " asperities overlap, which Greenwood and Tripp take to be sparse");
  }
  const double product = roughness_product(scene.roughness);
  if (product < kLeastRoughnessProduct || product > kMostRoughnessProduct) {
    warn("ROUGHNESS_PRODUCT", "eta_G beta_G sigma_G is " + short_text(product) +
                                  "; Greenwood and Tripp expect 0.03 to 0.05 for steel on steel");
  }
  if (r.limiting_stress_area_share > 0.5) {
    warn("LIMITING_STRESS", short_text(100 * r.limiting_stress_area_share) +
                                " % of the loaded area is at the limiting shear stress, which " +
                                limiting_stress_origin(scene.fluid_grounds.limiting_stress) +
                                " and is taken to be independent of temperature");
  }
  if (inlet < 20) {
    warn("COLD_INLET",
         "the inlet is at " + short_text(inlet) +
             " C; inlet shear heating and starvation thin the film of cold oil and are not "
             "modelled");
  }
  if (!r.settled) {
    warn("NOT_SETTLED", "no period of 1 to 4 mesh cycles settled within " +
                            std::to_string(r.statistics.mesh_cycles) +
                            " mesh cycles: the figures are averages over " +
                            std::to_string(r.recorded_mesh_cycles) + " recorded cycles");
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
  if (scene.options.isothermal) {
    warn("ISOTHERMAL", "contact temperature held at the inlet's: friction at speed is too high");
  }
  return out;
}

}  // namespace tribodyn
