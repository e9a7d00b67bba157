#pragma once

#include <array>

#include "core/laws/lubricant.h"

namespace tribodyn {

/// A law of growth with pressure, ready to be evaluated: core/laws/pressure_growth-inl.h.
template <class Parameter>
struct GrowthLaw {
  PressureViscosityLaw law = PressureViscosityLaw::kRoelands;
  Parameter vogel_coefficient;  ///< A_1 of eq 34 [K]
  Parameter vogel_reference;    ///< T_0 of eq 34 [K]
  Parameter width;              ///< C_2 of the improved Yasutomi law [K]
  std::array<Parameter, kMostLawParameters> parameters;
};

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
