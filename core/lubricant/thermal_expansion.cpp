#include "core/lubricant/thermal_expansion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/celsius.h"
#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

constexpr double kFifteenCelsius = 288.15;
constexpr double kDensityUncertainty = 0.5;  // of a measured density, ASTM D4052 [kg/m3], assumed

void check_density(double density, const std::string& where) {
  if (!(density >= 600 && density <= 1500)) {
    throw Refusal("DENSITY_OUT_OF_RANGE", "A density of " + number_text(density) + " kg/m3" +
                                              where + ": it must be from 600 to 1500 kg/m3.");
  }
}

double slope_uncertainty(BaseOilClass base_oil) {
  const bool is_covered = base_oil != BaseOilClass::kEster &&
                          base_oil != BaseOilClass::kPolyalkyleneGlycol &&
                          base_oil != BaseOilClass::kUnspecified;
  return is_covered ? 0.05 : 0.15;
}

// Chord of ASTM D1250 from 15 to 100 C [kg/(m3 K)].
double chord(double density_15) {
  return (expanded_density(density_15, kHundredCelsius) - density_15) /
         (kHundredCelsius - kFifteenCelsius);
}

// The line of a given slope through one point.
DensityLaw through(const DensityPoint& point, double slope, double relative_uncertainty) {
  const double slope_error = relative_uncertainty * std::abs(slope);
  return {point.density - slope * point.temperature, slope, slope_error * point.temperature,
          slope_error};
}

}  // namespace

double expanded_density(double density_15, double temperature) {
  const double product = kLubricatingOilExpansion / density_15 * (temperature - kFifteenCelsius);
  return density_15 * std::exp(-product * (1 + 0.8 * product));
}

DensityLaw density_law(double density_15, BaseOilClass base_oil) {
  check_density(density_15, " at 15 C");
  return through({kFifteenCelsius, density_15}, chord(density_15), slope_uncertainty(base_oil));
}

DensityLaw density_law(std::span<const DensityPoint> points, BaseOilClass base_oil) {
  if (points.empty()) throw Refusal("DENSITY_TABLE_EMPTY", "No density is given.");
  double mean_temperature = 0, mean_density = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [temperature, density] = points[i];
    const std::string row = " in row " + std::to_string(i + 1);
    check_density(density, row);
    if (!(temperature >= 200 && temperature <= 620)) {
      throw Refusal("DENSITY_OUT_OF_RANGE", "A temperature of " + celsius_text(temperature) + row +
                                                ": it must be from -73.15 to 346.85 C.");
    }
    mean_temperature += temperature / static_cast<double>(points.size());
    mean_density += density / static_cast<double>(points.size());
  }
  double spread = 0, moment = 0;
  for (const auto& [temperature, density] : points) {
    spread += std::pow(temperature - mean_temperature, 2);
    moment += (temperature - mean_temperature) * (density - mean_density);
  }
  const auto [coldest, warmest] = std::minmax_element(
      points.begin(), points.end(),
      [](const DensityPoint& a, const DensityPoint& b) { return a.temperature < b.temperature; });
  const DensityPoint centre{mean_temperature, mean_density};
  if (warmest->temperature - coldest->temperature < 1) {
    // D1250 wants the density at 15 C; its slope hardly depends on it.
    const double density_15 =
        mean_density + kLubricatingOilExpansion * (mean_temperature - kFifteenCelsius);
    check_density(density_15, " at 15 C (expanded by ASTM D1250)");
    return through(centre, chord(density_15), slope_uncertainty(base_oil));
  }
  const double slope = moment / spread;
  if (!(slope < 0)) {
    throw Refusal("DENSITY_RISES", "The densities rise with temperature, by " + number_text(slope) +
                                       " kg/(m3 K): a liquid expands.");
  }
  DensityLaw law = through(centre, slope, 0);
  double squares = 0;
  for (const auto& [temperature, density] : points) {
    squares += std::pow(density - law.density_at_zero_kelvin - slope * temperature, 2);
  }
  const auto count = static_cast<double>(points.size());
  law.root_mean_square_residual = std::sqrt(squares / count);
  const double scatter = count > 2 ? std::max(kDensityUncertainty, std::sqrt(squares / (count - 2)))
                                   : kDensityUncertainty;
  law.slope_uncertainty = scatter / std::sqrt(spread);
  law.density_at_zero_uncertainty = law.slope_uncertainty * mean_temperature;
  return law;
}

}  // namespace tribodyn
