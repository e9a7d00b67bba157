#include "core/lubricant/viscosity_temperature.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/celsius.h"
#include "core/lubricant/viscosity.h"
#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

constexpr double kLowestTemperature = 200, kHighestTemperature = 620;  // K

[[noreturn]] void refuse(const std::string& sentence) {
  throw Refusal("VISCOSITY_TEMPERATURE_LINE", sentence + " (ASTM D341)");
}

double low_viscosity_term(double v) { return std::exp(-1.47 - (1.84 + 0.51 * v) * v); }

double ordinate(const KinematicViscosityPoint& point) {
  if (!(point.temperature >= kLowestTemperature && point.temperature <= kHighestTemperature)) {
    refuse("A temperature of " + celsius_text(point.temperature) +
           ": it must be from -73.15 to 346.85 C");
  }
  if (!(point.kinematic_viscosity >= kLowestKinematicViscosity &&
        point.kinematic_viscosity <= kHighestKinematicViscosity)) {
    refuse("A kinematic viscosity of " + number_text(1e6 * point.kinematic_viscosity) +
           " mm2/s at " + celsius_text(point.temperature) +
           ": the equation is stated for 0.21 to 2e7 mm2/s");
  }
  const double v = 1e6 * point.kinematic_viscosity;
  return std::log10(std::log10(v + 0.7 + low_viscosity_term(v)));
}

}  // namespace

ViscosityTemperatureLine viscosity_temperature_line(const KinematicViscosityPoint& first,
                                                    const KinematicViscosityPoint& second) {
  const double w1 = ordinate(first), w2 = ordinate(second);
  if (!(std::abs(first.temperature - second.temperature) >= 1)) {
    refuse("Two temperatures less than 1 K apart, " +
           number_text(first.temperature - kZeroCelsius) + " and " +
           number_text(second.temperature - kZeroCelsius) + " C");
  }
  const double slope = (w1 - w2) / std::log10(second.temperature / first.temperature);
  if (!(slope > 0)) {
    const auto& [cold, warm] = first.temperature < second.temperature ? std::pair{first, second}
                                                                      : std::pair{second, first};
    refuse("A kinematic viscosity of " + number_text(1e6 * warm.kinematic_viscosity) +
           " mm2/s at " + celsius_text(warm.temperature) + " must be below that at " +
           celsius_text(cold.temperature) + ", " + number_text(1e6 * cold.kinematic_viscosity) +
           " mm2/s");
  }
  return {first.temperature, w1, slope};
}

double kinematic_viscosity(const ViscosityTemperatureLine& line, double temperature) {
  const double w =
      line.reference_ordinate - line.slope * std::log10(temperature / line.reference_temperature);
  const double z = std::pow(10.0, std::pow(10.0, w));
  // Newton from the right of a convex, rising function: every step stays right of the root.
  double v = z - 0.7;
  for (int i = 0; i < 50 && v > 0; ++i) {
    const double term = low_viscosity_term(v);
    const double step = (v + 0.7 + term - z) / (1 - (1.84 + 1.02 * v) * term);
    v -= step;
    if (!(std::abs(step) > 1e-16 * v)) break;
  }
  // the margin keeps the points of the line themselves inside
  if (!(1e-6 * v >= kLowestKinematicViscosity * (1 - 1e-9) &&
        1e-6 * v <= kHighestKinematicViscosity * (1 + 1e-9))) {
    refuse("At " + celsius_text(temperature) + " the line leaves the range of 0.21 to 2e7 mm2/s");
  }
  return 1e-6 * v;
}

double kinematic_viscosity(const Lubricant& lubricant, double temperature) {
  return ambient_viscosity(lubricant, temperature) / density(lubricant, temperature);
}

double temperature_of_viscosity(const Lubricant& lubricant, double viscosity) {
  return laws::vogel_temperature(lubricant.vogel_temperature_coefficient,
                                 lubricant.vogel_reference_temperature,
                                 std::log(viscosity / lubricant.vogel_viscosity_prefactor));
}

}  // namespace tribodyn
