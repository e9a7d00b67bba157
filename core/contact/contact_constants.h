#pragma once

#include "core/laws/shear_law.h"

namespace tribodyn {

/// What follows from a contact's parameters alone.
template <class Real>
struct ContactConstants {
  Real inlet_temperature;               ///< T_in [K]
  Real log_inlet_viscosity;             ///< ln eta_0(T_in), Pa s
  Real pressure_viscosity_coefficient;  ///< alpha*(T_in) [1/Pa]
  Real reduced_modulus;                 ///< E' [Pa]
  Real log_film;                        ///< see log_film_constant
  Real log_thermal_loading;             ///< see log_thermal_loading of laws
  Real asperity_load_factor;            ///< W_asp/(A_EHL F_5/2) [Pa]
  Real asperity_area_factor;            ///< A_asp/(A_EHL F_2) [-]
  Real conductance_factor_1, conductance_factor_2;
  ShearLaw<Real> shear;
};

}  // namespace tribodyn
