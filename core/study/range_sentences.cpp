#include "core/study/range_sentences.h"

#include "core/celsius.h"
#include "core/number_text.h"
#include "core/study/figure_limits.h"
#include "core/surface/roughness_product.h"

namespace tribodyn {
namespace {

std::string brief_text(double value) { return number_text(value, kRangeDigits); }

std::string range_text(double low, double high, const char* unit) {
  return brief_text(low) + " to " + brief_text(high) + " " + unit;
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

std::string viscosity_sentence(const FluidGrounds& grounds, double inlet_temperature,
                               double highest_temperature) {
  if (!grounds.viscosity_measured) return {};
  const double inlet = inlet_temperature - kZeroCelsius;
  const double highest_film = highest_temperature - kZeroCelsius;
  const double lowest = grounds.viscosity_measured->lowest - kZeroCelsius;
  const double highest = grounds.viscosity_measured->highest - kZeroCelsius;
  // Kelvin and back leaves an error in the 14th digit.
  constexpr double kRounding = 1e-9;
  if (inlet >= lowest - kRounding && highest_film <= highest + kRounding) return {};
  return "the film is at " + range_text(inlet, highest_film, "C") +
         "; the viscosity of this lubricant was measured from " + range_text(lowest, highest, "C") +
         " and is extrapolated beyond";
}

std::string pressure_sentence(double pressure) {
  const double gigapascals = 1e-9 * pressure;
  constexpr double kLowest = 1e-9 * kLowestComparedPressure;
  constexpr double kHighest = 1e-9 * kHighestComparedPressure;
  if (gigapascals >= kLowest && gigapascals <= kHighest) return {};
  return "the largest contact pressure is " + brief_text(gigapascals) + " GPa, " +
         (gigapascals < kLowest ? "below" : "above") + " the " +
         range_text(kLowest, kHighest, "GPa") +
         " at which the friction model was compared with measurements (fig 5)";
}

std::string film_ratio_sentence(double film_ratio) {
  if (!(film_ratio < kSparseAsperities)) return {};
  return "the film ratio falls to " + brief_text(film_ratio) + "; below about " +
         brief_text(kSparseAsperities) +
         " asperities overlap, which Greenwood and Tripp take to be sparse";
}

std::string roughness_product_sentence(const Roughness& roughness) {
  const double product = roughness_product(roughness);
  if (product >= kLeastRoughnessProduct && product <= kMostRoughnessProduct) return {};
  return "eta_G beta_G sigma_G is " + brief_text(product) +
         "; Greenwood and Tripp expect 0.03 to 0.05 for steel on steel";
}

std::string limiting_stress_sentence(const FluidGrounds& grounds, double area_share) {
  if (!(area_share > 0.5)) return {};
  return brief_text(100 * area_share) +
         " % of the loaded area is at the limiting shear stress, which " +
         limiting_stress_origin(grounds.limiting_stress) +
         " and is taken to be independent of temperature";
}

std::string inlet_heating_sentence(double heating_factor, const ModelOptions& options) {
  constexpr double kWorthIncluding = 0.95;
  if (options.inlet_shear_heating || !(heating_factor < kWorthIncluding)) return {};
  return "shear heating of the inlet, which the model leaves out, thins the film to " +
         brief_text(100 * heating_factor) +
         " % of its thickness: do not rank oils here without inlet_shear_heating";
}

std::string starvation_sentence(double heating_factor, const ModelOptions& options) {
  constexpr double kLikelyToStarve = 0.5;
  if (!options.inlet_shear_heating || !(heating_factor < kLikelyToStarve)) return {};
  return "shear heating of the inlet thins the film to " + brief_text(100 * heating_factor) +
         " % of its thickness; starvation thins the film of so thick an oil further and is not "
         "modelled";
}

std::string viscosity_range_sentence(double viscosity) {
  if (viscosity >= kLeastViscosity && viscosity <= kMostViscosity) return {};
  return "the viscosity at the inlet is " + brief_text(viscosity) + " Pa s, " +
         (viscosity < kLeastViscosity ? "below" : "above") + " the " +
         range_text(kLeastViscosity, kMostViscosity, "Pa s") + " of lubricating oils";
}

std::string thick_film_sentence(double film_thickness) {
  if (!(film_thickness > kThickestFilm)) return {};
  return "the film is " + brief_text(1e6 * film_thickness) + " um thick; above " +
         brief_text(1e6 * kThickestFilm) + " um no contact is fed with so much oil";
}

std::string no_lubricated_contact_sentence(double friction, double temperature) {
  if (friction > kMostFriction) {
    return "the friction coefficient is " + brief_text(friction) +
           "; that of a lubricated contact " + "is below " + brief_text(kMostFriction);
  }
  if (!(temperature > kHottestFilm)) return {};
  return "the film is at " + brief_text(temperature - kZeroCelsius) + " C; above " +
         brief_text(kHottestFilm - kZeroCelsius) + " C every oil decomposes";
}

std::string isothermal_sentence(const ModelOptions& options) {
  if (!options.isothermal) return {};
  return "contact temperature held at the inlet's: friction at speed is too high";
}

}  // namespace tribodyn
