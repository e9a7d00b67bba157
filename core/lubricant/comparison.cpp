#include "core/lubricant/comparison.h"

#include <cmath>

#include "core/celsius.h"
#include "core/laws/laws.h"
#include "core/lubricant/viscosity.h"
#include "core/lubricant/viscosity_index.h"
#include "core/lubricant/viscosity_temperature.h"
#include "core/refusal.h"

namespace tribodyn {

LubricantFigures lubricant_figures(const Lubricant& lubricant, const ModelOptions& options) {
  constexpr double kSeventyCelsius = kZeroCelsius + 70;
  constexpr double kGigapascal = 1e9;
  LubricantFigures figures;
  figures.kinematic_viscosity_40 = kinematic_viscosity(lubricant, kFortyCelsius);
  figures.kinematic_viscosity_100 = kinematic_viscosity(lubricant, kHundredCelsius);
  try {
    figures.viscosity_index = viscosity_index(1e6 * figures.kinematic_viscosity_40,
                                              1e6 * figures.kinematic_viscosity_100);
  } catch (const Refusal&) {  // D2270 does not define one
  }
  const auto factor = [&](double temperature) {
    return roelands_factor(log_ambient_viscosity(lubricant, temperature), options.as_published);
  };
  const bool houpert = options.pressure_viscosity_index == PressureViscosityIndex::kHoupert ||
                       options.as_published.eq31_32_logarithm;
  const double where_measured = factor(lubricant.pressure_viscosity_temperature);
  const double index =
      houpert ? index_from_houpert(where_measured, lubricant.pressure_viscosity_coefficient)
              : index_from_reciprocal_asymptotic(where_measured,
                                                 lubricant.pressure_viscosity_coefficient);
  for (const double temperature : {kFortyCelsius, kSeventyCelsius, kHundredCelsius}) {
    if (temperature <= lubricant.vogel_reference_temperature) continue;
    const double log_eta = log_ambient_viscosity(lubricant, temperature);
    const double here = factor(temperature);
    if (!(here > 0) || !std::isfinite(log_eta)) continue;
    figures.at.push_back({temperature, std::exp(log_eta),
                          std::exp(log_viscosity_under_pressure(log_eta, here, index, kGigapascal)),
                          houpert ? index * laws::kRoelandsPressureCoefficient * here
                                  : reciprocal_asymptotic_coefficient(here, index)});
  }
  return figures;
}

}  // namespace tribodyn
