#pragma once

namespace tribodyn {

/// How viscosity grows with pressure.
enum class PressureViscosityLaw {
  kRoelands,          ///< eq 31, its index Z from alpha* by eq 33 or eq 32
  kImprovedYasutomi,  ///< from the five parameters below; alpha* follows from the law
};

/// Parameters of the improved Yasutomi law beside those of eq 34 (improved_yasutomi_growth of
/// core/laws). SI units.
template <class Real>
struct ImprovedYasutomiOf {
  Real glass_viscosity = 0.0;              ///< eta_g [Pa s], by convention 1e12
  Real glass_temperature_rise = 0.0;       ///< A_1 [K]
  Real glass_pressure_factor = 0.0;        ///< A_2 [1/Pa]
  Real expansivity_pressure_factor = 0.0;  ///< b_1 [1/Pa]
  Real expansivity_exponent = 0.0;         ///< b_2 [-], negative
};

/// The properties of a fluid that enter the model. SI units. Laws: core/laws.
template <class Real>
struct LubricantOf {
  Real vogel_viscosity_prefactor;               ///< eta_ref of eq 34 [Pa s]
  Real vogel_temperature_coefficient;           ///< A_1 of eq 34 [K]
  Real vogel_reference_temperature;             ///< T_0,ref of eq 34 [K]
  Real pressure_viscosity_coefficient;          ///< alpha* of eq 33 [1/Pa]
  Real pressure_viscosity_temperature;          ///< temperature at which alpha* was measured [K]
  Real relaxation_time;                         ///< lambda of eq 24 at T_ref [s]
  Real havriliak_negami_alpha;                  ///< alpha_HN of eq 24 [-]
  Real havriliak_negami_beta;                   ///< beta_HN of eq 24 [-]
  Real rheology_reference_temperature;          ///< T_ref of eq 25 [K]
  Real limiting_shear_stress_at_zero_pressure;  ///< tau_L0 [Pa]
  Real limiting_shear_stress_coefficient;       ///< gamma_L [-]
  Real thermal_conductivity;                    ///< k_f [W/(m K)]
  Real density_at_zero_kelvin;                  ///< intercept of eq 26 [kg/m3]
  Real density_temperature_slope;               ///< slope of eq 26 [kg/(m3 K)]
  PressureViscosityLaw pressure_viscosity_law = PressureViscosityLaw::kRoelands;
  ImprovedYasutomiOf<Real> yasutomi{};  ///< of kImprovedYasutomi only
};

using Lubricant = LubricantOf<double>;

}  // namespace tribodyn
