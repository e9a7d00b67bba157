#pragma once

#include <array>

#include "core/laws/laws.h"

namespace tribodyn {

/// A film under a Hertzian pressure, sheared at one rate: what the mean stress depends on besides
/// temperature.
struct ShearedFilm {
  const ShearLaw<double>* law;
  double maximum_pressure;       ///< p_max [Pa] > 0
  double log_shear_rate;         ///< ln of eq 18, gamma_dot in 1/s
  bool limited;                  ///< stress restricted to tau_L
  bool all_derivatives = false;  ///< not that by temperature alone
};

/// log_stress with eq 31 as chosen.
template <class Real>
laws::LogStress<Real> log_stress(const ShearLaw<Real>& law, Real temperature, Real log_shear_rate) {
  auto out = laws::log_stress<Digits::kFull>(law, temperature, log_shear_rate);
  if (!law.roelands_misprinted) return out;
  const Real log_viscosity = out.factor - laws::kRoelandsLogViscosity;
  out.factor = laws::roelands_factor_as_published(log_viscosity);
  // d ln(eta + 9.67) = eta/(eta + 9.67) d ln eta
  out.factor_slope = out.factor_slope * laws::exponential(log_viscosity - out.factor);
  return out;
}

/// The area mean of eq 23 and how it came about.
struct MeanShearStress {
  double log_value;           ///< ln tau_bar, Pa
  double slope;               ///< d ln tau_bar / dT [1/K]
  double limited_area_share;  ///< share of the area on tau_L [-]
  int switches;               ///< radii at which eq 23 meets tau_L
  bool limited_at_centre;
  double by_base;  ///< d ln tau_bar/d base of LogStress
  /// Derivatives of ln tau_bar by what the growth with pressure depends on: L and Z of Roelands's
  /// law; the temperature, then GrowthLaw::parameters, of the others.
  /// Only the first one unless all_derivatives.
  std::array<double, kGrowthArguments> by_growth;
  // If all_derivatives: those of ln tau_bar by ln p_max, tau_L0 and gamma_L. The places where eq 23
  // meets tau_L do not enter: there the integrand is continuous.
  double by_log_pressure;
  double by_limit_at_zero_pressure;  ///< [1/Pa]
  double by_limit_coefficient;
};

/// tau_bar(T) = 2 int_0^1 min(tau(p_max xi), tau_L(p_max xi)) xi dxi: position enters only through
/// p = p_max xi.
///  1. The variable is s = ln(1 + 5.1e-9 p), in which eq 31 is entire.
///  2. The turns of ln(tau/tau_L) divide [0, s_max] into pieces on which it is monotone; in each
///     the place where tau meets tau_L, if any, is a root by safeguarded Newton.
///  3. Between those places tau is integrated by Gauss-Legendre rules of 12 to 20 nodes, on panels
///     over which it grows by at most 20 powers of e; on tau_L the integral is in closed form.
/// Relative error below 1e-13; of the improved Yasutomi law, whose logarithms end at negative
/// pressures, below 1e-10. (P. J. Davis and P. Rabinowitz, Methods of Numerical Integration, 2nd
/// ed., 1984, for Gauss rules; L. N. Trefethen, Approximation Theory and Approximation Practice,
/// 2013, for their convergence on analytic functions.) temperature [K] above T_0,ref.
/// `switch_guess` speeds up repeated calls for one film: start with 0, do not touch.
MeanShearStress mean_shear_stress(const ShearedFilm& film, double temperature,
                                  double& switch_guess);

/// ln(tau/tau_L) at the centre, at a temperature [K] above T_0,ref.
double log_stress_over_limit(const ShearedFilm& film, double temperature);

}  // namespace tribodyn
