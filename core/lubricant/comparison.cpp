#include "core/lubricant/comparison.h"

#include <cmath>

#include "core/celsius.h"
#include "core/lubricant/pressure_response.h"
#include "core/lubricant/viscosity.h"
#include "core/lubricant/viscosity_index.h"
#include "core/lubricant/viscosity_temperature.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

constexpr double kGigapascal = 1e9;

}  // namespace

LubricantFigures lubricant_figures(const Lubricant& lubricant, const ModelOptions& options) {
  constexpr double kSeventyCelsius = kZeroCelsius + 70;
  LubricantFigures figures;
  figures.kinematic_viscosity_40 = kinematic_viscosity(lubricant, kFortyCelsius);
  figures.kinematic_viscosity_100 = kinematic_viscosity(lubricant, kHundredCelsius);
  try {
    figures.viscosity_index = viscosity_index(1e6 * figures.kinematic_viscosity_40,
                                              1e6 * figures.kinematic_viscosity_100);
  } catch (const Refusal&) {  // D2270 does not define one
  }
  const PressureResponse response(lubricant, options);
  for (const double temperature : {kFortyCelsius, kSeventyCelsius, kHundredCelsius}) {
    const double log_eta = log_ambient_viscosity(lubricant, temperature);
    if (!std::isfinite(log_eta)) continue;
    try {
      response.check_at(temperature);
    } catch (const Refusal&) {  // the law does not hold there
      continue;
    }
    figures.at.push_back({temperature, std::exp(log_eta),
                          std::exp(log_eta + response.log_growth(temperature, kGigapascal)),
                          response.coefficient(temperature)});
  }
  return figures;
}

}  // namespace tribodyn
