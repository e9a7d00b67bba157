#include "core/lubricant/pressure_response.h"

#include <cmath>

#include "core/laws/laws.h"
#include "core/lubricant/viscosity.h"

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
  check_above_vogel(lubricant_, temperature, "a temperature");
  check_pressure_growth(lubricant_, temperature, as_published_);
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
