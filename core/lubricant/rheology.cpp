#include "core/lubricant/rheology.h"

#include <cmath>

#include "core/lubricant/viscosity.h"

namespace tribodyn {

double time_temperature_reference(const Lubricant& lubricant) {
  const double temperature = lubricant.rheology_reference_temperature;
  return log_ambient_viscosity(lubricant, temperature) -
         std::log(temperature * density(lubricant, temperature));
}

TimeTemperatureShift time_temperature_shift(const Lubricant& lubricant, double reference,
                                            double temperature, double log_ambient_viscosity,
                                            double log_ambient_viscosity_slope) {
  const double rho = density(lubricant, temperature);
  return {
      log_ambient_viscosity - std::log(temperature * rho) - reference,
      log_ambient_viscosity_slope - 1 / temperature - lubricant.density_temperature_slope / rho};
}

ShearThinning havriliak_negami(const Lubricant& lubricant, double log_reduced_shear_rate) {
  const double alpha = lubricant.havriliak_negami_alpha, beta = lubricant.havriliak_negami_beta;
  const double x = alpha * log_reduced_shear_rate;
  if (x > 36) return {beta * x, alpha * beta};  // ln(1 + e^x) = x to the last bit
  const double power = std::exp(x);
  return {beta * std::log1p(power), alpha * beta * power / (1 + power)};
}

double limiting_shear_stress(const Lubricant& lubricant, double pressure) {
  return lubricant.limiting_shear_stress_at_zero_pressure +
         lubricant.limiting_shear_stress_coefficient * pressure;
}

}  // namespace tribodyn
