#pragma once

#include "core/contact/mean_shear_stress.h"

namespace tribodyn {

/// T_c of eqs 38 and 39 and the stress there. roots: thermal equilibria found (0: none).
struct ThermalEquilibrium {
  int roots;
  double temperature;  ///< [K]; the coldest equilibrium
  MeanShearStress stress;
};

/// Solves T = base + gain tau_bar(T), base = T_in plus the heating by asperities [K], gain [K/Pa],
/// as a root in ln(T - base). Where shear thinning leaves tau_bar provably falling with temperature
/// (alpha_HN beta_HN well below 1, or Newtonian) there is exactly one root and Newton's bracket is
/// closed from the start; elsewhere the whole range up to the zero of the density law is scanned
/// and all roots are counted. None where base is outside eqs 26 and 34. gain = 0 (isothermal)
/// evaluates the stress at base.
ThermalEquilibrium solve_thermal_equilibrium(const ShearedFilm& film, double base, double gain);

}  // namespace tribodyn
