#pragma once

namespace tribodyn {

/// Everything that the model knows of a fluid. SI units. Laws: viscosity.h, rheology.h.
struct Lubricant {
  double vogel_viscosity_prefactor;               ///< eta_ref of eq 34 [Pa s]
  double vogel_temperature_coefficient;           ///< A_1 of eq 34 [K]
  double vogel_reference_temperature;             ///< T_0,ref of eq 34 [K]
  double pressure_viscosity_coefficient;          ///< alpha* of eq 33 [1/Pa]
  double pressure_viscosity_temperature;          ///< temperature at which alpha* was measured [K]
  double relaxation_time;                         ///< lambda of eq 24 at T_ref [s]
  double havriliak_negami_alpha;                  ///< alpha_HN of eq 24 [-]
  double havriliak_negami_beta;                   ///< beta_HN of eq 24 [-]
  double rheology_reference_temperature;          ///< T_ref of eq 25 [K]
  double limiting_shear_stress_at_zero_pressure;  ///< tau_L0 [Pa]
  double limiting_shear_stress_coefficient;       ///< gamma_L [-]
  double thermal_conductivity;                    ///< k_f [W/(m K)]
  double density_at_zero_kelvin;                  ///< intercept of eq 26 [kg/m3]
  double density_temperature_slope;               ///< slope of eq 26 [kg/(m3 K)]
};

}  // namespace tribodyn
