#pragma once

#include <string>

#include "core/lubricant/base_oil.h"

namespace tribodyn {

/// A value from a correlation, with its standard uncertainty in the same unit.
struct Estimate {
  double value;
  double standard_uncertainty;
  std::string source;  ///< citation, class and range of validity
  bool inside_range;   ///< whether the arguments lie in that range
};

/// alpha* [1/Pa] from the kinematic viscosity [m2/s] at the same temperature, by class.
Estimate estimate_pressure_viscosity_coefficient(BaseOilClass base_oil, double kinematic_viscosity);

/// alpha* [1/Pa] of mineral oils from viscosity [m2/s], density [kg/m3] at atmospheric pressure and
/// the slope B of ASTM D341, So and Klaus 1980. A second opinion, not used by characterise().
Estimate so_klaus_pressure_viscosity_coefficient(double kinematic_viscosity, double density,
                                                 double viscosity_temperature_slope);

/// k_f [W/(m K)] at atmospheric pressure and a temperature [K]; density_15 [kg/m3].
Estimate estimate_thermal_conductivity(BaseOilClass base_oil, double density_15,
                                       double temperature);

/// gamma_L [-] of tau_L = tau_L0 + gamma_L p.
Estimate estimate_limiting_shear_stress_coefficient(BaseOilClass base_oil);

/// tau_L0 [Pa].
Estimate estimate_limiting_shear_stress_at_zero_pressure(BaseOilClass base_oil);

/// lambda of eq 24 [s] at 70 C from the dynamic viscosity [Pa s] there.
Estimate estimate_relaxation_time(double viscosity);
Estimate estimate_havriliak_negami_alpha();
Estimate estimate_havriliak_negami_beta();

/// Density at 15 C [kg/m3] typical of the class, where nobody measured it.
Estimate estimate_density_15(BaseOilClass base_oil);

}  // namespace tribodyn
