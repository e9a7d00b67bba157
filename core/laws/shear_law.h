#pragma once

#include <array>

#include "core/laws/lubricant.h"

namespace tribodyn {

/// Parameters of a law of growth with pressure as it is evaluated. Those of the law itself are
/// first, by their indices in LubricantOf::law_parameters.
enum GrowthParameter {
  kVogelCoefficient = kMostLawParameters,  ///< A_1 of eq 34 [K]
  kVogelReference,                         ///< T_0 of eq 34 [K]
  kGrowthParameters
};

/// The place of eta_g holds C_2 of the improved Yasutomi law [K], which follows from eta_g and
/// eq 34.
inline constexpr int kGlassWidth = kGlassViscosity;

/// A law of growth with pressure, ready to be evaluated: core/laws/pressure_growth-inl.h.
template <class Parameter>
struct GrowthLaw {
  PressureViscosityLaw law = PressureViscosityLaw::kRoelands;
  std::array<Parameter, kGrowthParameters> parameters;
};

/// What growth depends on besides pressure: the temperature, then the parameters of the law.
inline constexpr int kGrowthArguments = 1 + kGrowthParameters;

/// What the stress of one lubricant depends on besides temperature, shear rate and pressure.
/// Parameter is double or a dual number.
template <class Parameter>
struct ShearLaw {
  LubricantOf<Parameter> lubricant;
  Parameter log_vogel_prefactor;
  Parameter log_relaxation_time;
  Parameter shift_reference;  ///< ln(eta_0/(T rho)) at T_ref
  Parameter index;            ///< Z; of Roelands's law only
  /// About d ln(T rho)/dT [1/K], for steps with half of the digits.
  double coarse_heat_density_slope;
  GrowthLaw<Parameter> growth{};  ///< of laws other than eq 31
  bool newtonian;                 ///< F = 1
  bool roelands_misprinted;       ///< L as published; not for packs
};

}  // namespace tribodyn
