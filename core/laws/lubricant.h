#pragma once

#include <array>

#include "core/parameter_check.h"

namespace tribodyn {

/// How viscosity grows with pressure. The formulas of all but the first:
/// core/laws/pressure_growth-inl.h.
enum class PressureViscosityLaw {
  kRoelands,          ///< eq 31, its index Z from alpha* by eq 33 or eq 32
  kImprovedYasutomi,  ///< of the five parameters below; alpha* follows from the law
};

/// A parameter of a law beside those of eq 34.
struct LawParameter {
  const char* name;
  const char* unit;  ///< SI; "1" for none
  Bound bound;
};

/// Indices of the parameters of the improved Yasutomi law.
enum ImprovedYasutomiParameter {
  kGlassViscosity,             ///< eta_g [Pa s], by convention 1e12
  kGlassTemperatureRise,       ///< A_1 [K]
  kGlassPressureFactor,        ///< A_2 [1/Pa]
  kExpansivityPressureFactor,  ///< b_1 [1/Pa]
  kExpansivityExponent,        ///< b_2 [-], negative
};

/// The greatest number of parameters that a law has.
inline constexpr int kMostLawParameters = 5;

/// A law and its parameters, by index; those of Roelands's law are members of LubricantOf.
struct LawDescription {
  PressureViscosityLaw law;
  const char* name;
  std::array<LawParameter, kMostLawParameters> parameters;
};

inline constexpr std::array kLawDescriptions{
    LawDescription{PressureViscosityLaw::kRoelands, "roelands", {}},
    LawDescription{PressureViscosityLaw::kImprovedYasutomi,
                   "improved_yasutomi",
                   {{{"glass_viscosity", "Pa s", Bound::kPositive},
                     {"glass_temperature_rise", "K", Bound::kNotNegative},
                     {"glass_pressure_factor", "1/Pa", Bound::kNotNegative},
                     {"expansivity_pressure_factor", "1/Pa", Bound::kNotNegative},
                     {"expansivity_exponent", "1", Bound::kNotPositive}}}},
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
  std::array<Real, kMostLawParameters> law_parameters{};  ///< as kLawDescriptions names them; SI
};

using Lubricant = LubricantOf<double>;

}  // namespace tribodyn
