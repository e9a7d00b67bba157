#include "core/lubricant/pressure_response.h"

#include <cmath>

#include "core/celsius.h"
#include "core/laws/laws.h"
#include "core/lubricant/viscosity.h"
#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {

PressureResponse::PressureResponse(const Lubricant& lubricant, const ModelOptions& options)
    : lubricant_(lubricant), as_published_(options.as_published) {
  if (lubricant.pressure_viscosity_law != PressureViscosityLaw::kRoelands) {
    growth_ = laws::growth_law(lubricant, std::log(lubricant.vogel_viscosity_prefactor));
    return;
  }
  has_houpert_index_ = options.pressure_viscosity_index == PressureViscosityIndex::kHoupert ||
                       as_published_.eq31_32_logarithm;
  const double where_measured = factor_at(lubricant.pressure_viscosity_temperature);
  const double coefficient = lubricant.pressure_viscosity_coefficient;
  index_ = has_houpert_index_ ? laws::houpert_index(where_measured, coefficient)
                              : index_from_reciprocal_asymptotic(where_measured, coefficient);
}

double PressureResponse::factor_at(double temperature) const {
  return roelands_factor(log_ambient_viscosity(lubricant_, temperature), as_published_);
}

void PressureResponse::check_at(double temperature) const {
  if (!(temperature > lubricant_.vogel_reference_temperature)) {
    throw Refusal("BELOW_VOGEL_TEMPERATURE",
                  "a temperature of " + number_text(temperature - kZeroCelsius) +
                      " C is not above the Vogel reference temperature of " +
                      number_text(lubricant_.vogel_reference_temperature - kZeroCelsius) +
                      " C: eq 34 has no viscosity there");
  }
  if (lubricant_.pressure_viscosity_law != PressureViscosityLaw::kRoelands) {
    check_greatest_viscosity(lubricant_, temperature);
  } else if (!(factor_at(temperature) > 0)) {
    throw Refusal("ROELANDS_FACTOR",
                  "ln eta_0 + 9.67 of eq 31 is not positive: the fluid is too thin for the law");
  }
}

double PressureResponse::log_growth(double temperature, double pressure) const {
  return lubricant_.pressure_viscosity_law != PressureViscosityLaw::kRoelands
             ? laws::pressure_growth(growth_, temperature, pressure)
             : log_viscosity_under_pressure(0, factor_at(temperature), index_, pressure);
}

double PressureResponse::coefficient(double temperature) const {
  if (lubricant_.pressure_viscosity_law != PressureViscosityLaw::kRoelands) {
    return reciprocal_asymptotic_of_growth(growth_, temperature);
  }
  const double factor = factor_at(temperature);
  return has_houpert_index_ ? index_ * laws::kRoelandsPressureCoefficient * factor
                            : laws::roelands_reciprocal_asymptotic(factor, index_);
}

}  // namespace tribodyn
