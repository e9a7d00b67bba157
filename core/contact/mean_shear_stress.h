#pragma once

#include "core/lubricant/lubricant.h"
#include "core/model_options.h"

namespace tribodyn {

/// A film under a Hertzian pressure, sheared at one rate: what the mean stress depends on besides
/// temperature.
struct ShearedFilm {
  const Lubricant* lubricant;
  AsPublished as_published;
  double maximum_pressure;            ///< p_max [Pa] > 0
  double pressure_viscosity_index;    ///< Z [-]
  double log_shear_rate;              ///< ln of eq 18, gamma_dot in 1/s
  double time_temperature_reference;  ///< see rheology.h; unused when newtonian
  bool newtonian;                     ///< F = 1
  bool limited;                       ///< stress restricted to tau_L
};

/// The area mean of eq 23 and how it came about.
struct MeanShearStress {
  double log_value;           ///< ln tau_bar, Pa
  double slope;               ///< d ln tau_bar / dT [1/K]
  double limited_area_share;  ///< share of the area on tau_L [-]
  int switches;               ///< radii at which eq 23 meets tau_L
  bool limited_at_centre;
};

/// tau_bar(T) = 2 int_0^1 min(tau(p_max xi), tau_L(p_max xi)) xi dxi: position enters only through
/// p = p_max xi. Integrated in s = ln(1 + 5.1e-9 p), in which eq 31 is entire, by Gauss-Legendre
/// between the points where eq 23 meets tau_L (found as bracketed roots; the integral on tau_L is
/// in closed form). Relative error below 1e-13. temperature [K] above T_0,ref. `switch_guess`
/// speeds up repeated calls for one film: start with 0, do not touch.
MeanShearStress mean_shear_stress(const ShearedFilm& film, double temperature,
                                  double& switch_guess);

}  // namespace tribodyn
