#pragma once

#include "core/lubricant/lubricant.h"

namespace tribodyn {

/// What the stress of one lubricant depends on besides temperature, shear rate and pressure.
/// Parameter is double or a dual number.
template <class Parameter>
struct ShearLaw {
  LubricantOf<Parameter> lubricant;
  Parameter log_vogel_prefactor;
  Parameter log_relaxation_time;
  Parameter shift_reference;  ///< ln(eta_0/(T rho)) at T_ref
  Parameter index;            ///< Z
  /// About d ln(T rho)/dT [1/K], for steps with half of the digits.
  double coarse_heat_density_slope;
  bool newtonian;            ///< F = 1
  bool roelands_misprinted;  ///< L as published; not for packs
};

}  // namespace tribodyn
