#pragma once

#include "core/contact/mean_shear_stress.h"

namespace tribodyn {

/// T_c of eqs 38 and 39 and the stress there. roots: thermal equilibria found (0: none).
struct ThermalEquilibrium {
  int roots;
  double temperature;  ///< [K]; the coldest equilibrium
  MeanShearStress stress;
};

/// Solves T = base + gain tau_bar(T), base = T_in plus the heating by asperities [K], gain [K/Pa]:
///  1. The unknown is y = ln(T - base), the function H(y) = y - ln(gain tau_bar(T)).
///  2. If tau_bar provably falls with temperature (alpha_HN beta_HN well below 1, or Newtonian),
///     the slope of H is at least 1: there is one root, and each value of H closes both ends of the
///     bracket. The start takes tau_bar as an exponential of T (Lambert's W).
///  3. Newton's method inside of the bracket, with a bisection in every eighth step: plain Newton
///     may alternate between the plateau of the limited stress and its hot tail.
///  4. Otherwise the range of y, up to the zero of the density law, is halved until the values at
///  the
///     ends of each part and a bound of the slope of H prove that the part holds one root or none,
///     nine times at most; all roots are counted, the coldest one is returned.
/// (C. T. Kelley, Solving Nonlinear Equations with Newton's Method, 2003; R. M. Corless et al.,
/// Adv. Comput. Math. 5, 1996, 329, for Lambert's function.) No roots if base is outside eqs 26 and
/// 34. gain = 0 (isothermal) evaluates the stress at base.
ThermalEquilibrium solve_thermal_equilibrium(const ShearedFilm& film, double base, double gain);

}  // namespace tribodyn
