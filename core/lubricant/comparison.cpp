#include "core/lubricant/comparison.h"

#include <cmath>
#include <functional>
#include <optional>

#include "core/celsius.h"
#include "core/laws/laws.h"
#include "core/lubricant/viscosity.h"
#include "core/lubricant/viscosity_index.h"
#include "core/lubricant/viscosity_temperature.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

struct PressureResponseAt {
  double gigapascal_growth;  ///< ln(eta/eta_0) at 1 GPa
  double coefficient;        ///< alpha* [1/Pa]
};

/// From a temperature [K] and ln eta_0 there; nullopt if the law does not hold there.
using PressureResponse = std::function<std::optional<PressureResponseAt>(double, double)>;

constexpr double kGigapascal = 1e9;

PressureResponse roelands_response(const Lubricant& lubricant, const ModelOptions& options) {
  const AsPublished as_published = options.as_published;
  const bool houpert = options.pressure_viscosity_index == PressureViscosityIndex::kHoupert ||
                       as_published.eq31_32_logarithm;
  const double where_measured = roelands_factor(
      log_ambient_viscosity(lubricant, lubricant.pressure_viscosity_temperature), as_published);
  const double index =
      houpert ? index_from_houpert(where_measured, lubricant.pressure_viscosity_coefficient)
              : index_from_reciprocal_asymptotic(where_measured,
                                                 lubricant.pressure_viscosity_coefficient);
  return [=](double, double log_viscosity) -> std::optional<PressureResponseAt> {
    const double factor = roelands_factor(log_viscosity, as_published);
    if (!(factor > 0)) return std::nullopt;
    return PressureResponseAt{log_viscosity_under_pressure(0, factor, index, kGigapascal),
                              houpert ? index * laws::kRoelandsPressureCoefficient * factor
                                      : reciprocal_asymptotic_coefficient(factor, index)};
  };
}

PressureResponse response_of_growth(const Lubricant& lubricant) {
  const GrowthLaw<double> law =
      laws::growth_law(lubricant, std::log(lubricant.vogel_viscosity_prefactor));
  return [=](double temperature, double) -> std::optional<PressureResponseAt> {
    return PressureResponseAt{laws::pressure_growth(law, temperature, kGigapascal),
                              reciprocal_asymptotic_of_growth(law, temperature)};
  };
}

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
  const PressureResponse response =
      lubricant.pressure_viscosity_law == PressureViscosityLaw::kRoelands
          ? roelands_response(lubricant, options)
          : response_of_growth(lubricant);
  for (const double temperature : {kFortyCelsius, kSeventyCelsius, kHundredCelsius}) {
    if (temperature <= lubricant.vogel_reference_temperature) continue;
    const double log_eta = log_ambient_viscosity(lubricant, temperature);
    if (!std::isfinite(log_eta)) continue;
    if (const std::optional<PressureResponseAt> at = response(temperature, log_eta)) {
      figures.at.push_back({temperature, std::exp(log_eta),
                            std::exp(log_eta + at->gigapascal_growth), at->coefficient});
    }
  }
  return figures;
}

}  // namespace tribodyn
