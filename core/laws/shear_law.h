#pragma once

#include "core/lubricant/lubricant.h"

namespace tribodyn {

/// The improved Yasutomi law in terms of eq 34: with the glass transition temperature T_g [K] and
/// the factor F [-] of the pressure,
///   ln eta = ln eta_ref + A_V/(C_2 + (T - T_g) F),
/// A_V and T_0 being A_1 and T_0 of eq 34, C_2 = A_V/ln(eta_g/eta_ref) and T_g = T_0 + C_2 at p =
/// 0.
template <class Parameter>
struct GlassState {
  Parameter coefficient;  ///< A_V [K]
  Parameter reference;    ///< T_0 [K]
  Parameter width;        ///< C_2 [K]
  ImprovedYasutomiOf<Parameter> of_pressure;
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
  GlassState<Parameter> glass{};  ///< of the improved Yasutomi law only
  bool newtonian;                 ///< F = 1
  bool roelands_misprinted;       ///< L as published; not for packs
};

}  // namespace tribodyn
