#pragma once

#include "core/lubricant/lubricant.h"

namespace tribodyn {

/// ln a_TTS(T) of eq 25 and its slope d/dT [1/K]. temperature [K] above T_0,ref, where density(T) >
/// 0. The reference terms are passed in because they do not change: see TimeTemperatureReference.
struct TimeTemperatureShift {
  double log_factor;
  double slope;
};

/// ln(eta rho T) at T_ref; both must exist there.
double time_temperature_reference(const Lubricant& lubricant);
TimeTemperatureShift time_temperature_shift(const Lubricant& lubricant, double reference,
                                            double temperature, double log_ambient_viscosity,
                                            double log_ambient_viscosity_slope);

/// ln F of eq 24, beta ln(1 + (lambda a gamma_dot)^alpha), and its derivative with respect to
/// ln(lambda a gamma_dot). Never overflows; 0 for lambda a gamma_dot = 0 (log = -inf).
struct ShearThinning {
  double log_function;
  double slope;
};
ShearThinning havriliak_negami(const Lubricant& lubricant, double log_reduced_shear_rate);

/// tau_L = tau_L0 + gamma_L p [Pa] (Hoglund and Jacobson 1986).
double limiting_shear_stress(const Lubricant& lubricant, double pressure);

}  // namespace tribodyn
