// Viscosity and density of a lubricant.
// Templates on their number type, compiled per instruction set too: see core/laws/laws.h.
#if defined(TRIBODYN_CORE_LAWS_VISCOSITY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_LAWS_VISCOSITY_INL_H_
#undef TRIBODYN_CORE_LAWS_VISCOSITY_INL_H_
#else
#define TRIBODYN_CORE_LAWS_VISCOSITY_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "core/laws/shear_law.h"
#include "core/numerics/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

constexpr double kRoelandsPressureCoefficient = 5.1e-9;  ///< of eqs 31, 32 [1/Pa]
constexpr double kRoelandsLogViscosity = 9.67;           ///< of eqs 31, 32 [-]

/// ln eta_0(T) (Vogel 1921), eta_0 in Pa s, from ln eta_ref, A_1 [K], T_0 [K] and T [K] > T_0, and
/// its derivative by T [1/K].
template <class Parameter, class Real>
HWY_INLINE WithSlope<Real> log_vogel_viscosity(Parameter log_prefactor, Parameter coefficient,
                                               Parameter reference_temperature, Real temperature) {
  const Real inverse = 1 / (temperature - reference_temperature);
  const Real exponent = coefficient * inverse;
  return {exponent + log_prefactor, -(exponent * inverse)};  // (eq 34)
}

/// The inverse of eq 34: T [K] at which ln(eta_0/eta_ref) has a value, > 0, from A_1 [K] and T_0
/// [K].
template <class Parameter, class Real>
HWY_INLINE Real vogel_temperature(Parameter coefficient, Parameter reference_temperature,
                                  Real log_viscosity_ratio) {
  return coefficient / log_viscosity_ratio + reference_temperature;
}

/// rho(T) [kg/m3], linear in T [K]. Negative beyond at_zero_kelvin/|slope|.
template <class Parameter, class Real>
HWY_INLINE Real linear_density(Parameter at_zero_kelvin, Parameter slope, Real temperature) {
  return fused(slope, temperature, at_zero_kelvin);  // (eq 26)
}

/// L = ln eta_0 + 9.67 of Roelands (1966), the factor of eqs 31 and 32 that multiplies Z.
template <class Real>
HWY_INLINE Real roelands_factor(Real log_ambient_viscosity) {
  return log_ambient_viscosity + kRoelandsLogViscosity;
}

/// The same as the paper prints it.
template <class Real>
HWY_INLINE Real roelands_factor_as_published(Real log_ambient_viscosity) {
  return logarithm(exponential(log_ambient_viscosity) + kRoelandsLogViscosity);
}

/// ln eta(p), or that of a stress in proportion, from its value at ambient pressure, L and
/// (1 + 5.1e-9 p)^Z - 1.
template <class Real>
HWY_INLINE Real log_under_pressure(Real log_ambient, Real factor, Real growth) {
  return fused(factor, growth, log_ambient);  // (eq 31)
}

/// Z of Houpert (1985) from L and alpha* [1/Pa]: alpha* is then the slope of ln eta at p = 0.
template <class Real>
HWY_INLINE Real houpert_index(Real factor, Real coefficient) {
  return coefficient / (kRoelandsPressureCoefficient * factor);  // (eq 32)
}

/// e^L L^(1-s) Gamma(s, L), Gamma(s, L) the upper incomplete gamma function; not for packs.
/// For s in (0, 1] by Legendre's continued fraction, whose denominators are all positive there;
/// then upwards by Gamma(s + 1, L) = s Gamma(s, L) + L^s e^-L, in which all terms are. The error of
/// n terms falls as exp(-4 sqrt(n L)): 4 + 85/L of them leave 1e-14.
template <class Real>
Real scaled_incomplete_gamma(Real l, Real s) {
  const int steps = std::max(0, static_cast<int>(std::ceil(value_of(s))) - 1);
  Real order = s - steps;
  constexpr double kLeast = 0.01;  // bounds the work
  const int terms = 4 + static_cast<int>(85 / std::max(value_of(l), kLeast));
  Real denominator = l + (2 * terms + 1) - order;
  for (int k = terms; k > 0; --k) {
    denominator = l + (2 * k - 1) - order - k * (k - order) / denominator;
  }
  Real out = l / denominator;
  for (int k = 0; k < steps; ++k, order = order + 1) out = 1 + order / l * out;
  return out;
}

/// alpha* [1/Pa], the inverse of int_0^inf eta(0)/eta(p) dp, of a Roelands fluid of L and Z; not
/// for packs: int_0^inf exp(-L ((1 + c p)^Z - 1)) dp = e^L L^(-1/Z) Gamma(1/Z, L)/(Z c). Relative
/// error below 1e-13 for L in [0.5, 60] and Z in [0.05, 3].
template <class Real>
Real roelands_reciprocal_asymptotic(Real factor, Real index) {
  return index * kRoelandsPressureCoefficient * factor /
         scaled_incomplete_gamma(factor, 1 / index);  // (eq 33)
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_LAWS_VISCOSITY_INL_H_
