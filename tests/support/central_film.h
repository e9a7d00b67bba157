#pragma once

#include <cmath>

#include "core/laws/laws.h"

namespace tribodyn {

/// What the film of eq 12 depends on besides load. SI units.
struct FilmConditions {
  double entrainment_radius;              ///< R_e [m]
  double side_leakage_radius;             ///< R_s [m]
  double viscosity;                       ///< eta_0(T_in) [Pa s]
  double pressure_viscosity_coefficient;  ///< alpha*(T_in) [1/Pa]
  double entrainment_speed;               ///< U_eff [m/s]
  double reduced_modulus;                 ///< E' [Pa]
};

/// h_cen [m] by the laws of core/laws/film-inl.h.
inline double central_film(const FilmConditions& c, double load) {
  const double constant =
      laws::log_film_constant(std::log(c.viscosity), std::log(c.pressure_viscosity_coefficient),
                              std::log(c.reduced_modulus));
  return std::exp(laws::log_film(constant, 2 * std::log(c.entrainment_speed),
                                 -std::log(c.entrainment_radius), std::log(load))) *
         laws::side_leakage(std::log(c.side_leakage_radius / c.entrainment_radius));
}

}  // namespace tribodyn
