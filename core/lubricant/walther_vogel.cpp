#include "core/lubricant/walther_vogel.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/celsius.h"
#include "core/refusal.h"

namespace tribodyn {

double walther_reference_temperature(const ViscosityTemperatureLine& line,
                                     const DensityLaw& density) {
  const auto log_eta = [&](double temperature) {
    return std::log(kinematic_viscosity(line, temperature) *
                    (density.density_at_zero_kelvin + density.slope * temperature));
  };
  std::vector<std::pair<double, double>> targets;
  for (double temperature = kZeroCelsius - 10; temperature < kZeroCelsius + 151; temperature += 5) {
    try {
      targets.emplace_back(temperature, log_eta(temperature));
    } catch (const Refusal&) {  // the line ends here
    }
  }
  const double cold = log_eta(kFortyCelsius), warm = log_eta(kHundredCelsius);
  const auto squares = [&](double t0) {
    const double coefficient =
        (cold - warm) / (1 / (kFortyCelsius - t0) - 1 / (kHundredCelsius - t0));
    double sum = 0;
    for (const auto& [temperature, value] : targets) {
      const double law = warm + coefficient * (1 / (temperature - t0) - 1 / (kHundredCelsius - t0));
      sum += (law - value) * (law - value);
    }
    return sum;
  };
  // Golden section around the best of a coarse grid.
  double best = 50;
  for (double t0 = 50; t0 <= 250; t0 += 5) {
    if (squares(t0) < squares(best)) best = t0;
  }
  constexpr double kGolden = 0.6180339887498949;
  double lower = std::max(50.0, best - 5), upper = std::min(250.0, best + 5);
  for (int i = 0; i < 40; ++i) {
    const double left = upper - kGolden * (upper - lower);
    const double right = lower + kGolden * (upper - lower);
    (squares(left) < squares(right) ? upper : lower) =
        squares(left) < squares(right) ? right : left;
  }
  return (lower + upper) / 2;
}

}  // namespace tribodyn
