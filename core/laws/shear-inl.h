// Shear stress of a lubricant under pressure.
// Templates on their number type, compiled per instruction set too: see core/laws/laws.h.
#if defined(TRIBODYN_CORE_LAWS_SHEAR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_LAWS_SHEAR_INL_H_
#undef TRIBODYN_CORE_LAWS_SHEAR_INL_H_
#else
#define TRIBODYN_CORE_LAWS_SHEAR_INL_H_
#endif

#include <hwy/highway.h>

#include "core/laws/shear_law.h"
#include "core/laws/viscosity-inl.h"
#include "core/numerics/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

// The paper's Havriliak-Negami form F = (1 + (lambda a_TTS gamma_dot)^alpha_HN)^beta_HN is the law
// of Carreau and Yasuda without second Newtonian plateau: a_CY = alpha_HN, (1 - n)/a_CY = beta_HN.

/// ln a_TTS, the shift of the relaxation time with temperature, from ln eta_0 and ln(T rho), and
/// from the difference of the two at T_ref.
template <class Parameter, class Real>
HWY_INLINE Real log_time_temperature_shift(Real log_viscosity, Real log_heat_density,
                                           Parameter reference) {
  return log_viscosity - log_heat_density - reference;  // (eq 25)
}

/// Returns (lambda a_TTS gamma_dot)^alpha_HN from ln(lambda a_TTS gamma_dot). Never overflows.
template <Digits kDigits, class Parameter, class Real>
HWY_INLINE Real thinning_power(Parameter alpha, Real log_reduced_shear_rate) {
  return exponential<kDigits>(clamped(alpha * log_reduced_shear_rate, -600, 600));
}

/// ln F from 1 + that power.
template <Digits kDigits, class Parameter, class Real>
HWY_INLINE Real log_thinning(Parameter beta, Real sum) {
  return beta * logarithm<kDigits>(sum);  // (eq 24)
}

/// tau_L [Pa] = tau_L0 + gamma_L p (E. Hoglund and B. Jacobson, J. Tribol. 108 (1986) 571-577), or
/// from gamma_L/c and c p.
template <class Parameter, class Real>
HWY_INLINE Real limiting_shear_stress(Parameter at_zero_pressure, Parameter coefficient,
                                      Real pressure) {
  return fused(coefficient, pressure, at_zero_pressure);
}

/// The mean of tau_L over the area, which eq 19 loads with 2/3 of the greatest pressure.
template <class Parameter, class Real>
HWY_INLINE Real mean_limiting_shear_stress(Parameter at_zero_pressure, Parameter coefficient,
                                           Real maximum_pressure) {
  return limiting_shear_stress(at_zero_pressure, coefficient * 2 / 3, maximum_pressure);
}

/// ln tau = base + factor ((1 + 5.1e-9 p)^Z - 1) at one temperature and shear rate, tau in Pa.
template <class Real>
struct LogStress {
  Real base, factor;
  Real base_slope, factor_slope;  ///< by temperature [1/K]
};

/// At `temperature` [K] and the logarithm of the shear rate in 1/s.
template <Digits kDigits, class Parameter, class Real>
HWY_INLINE LogStress<Real> log_stress(const ShearLaw<Parameter>& law, Real temperature,
                                      Real log_shear_rate) {
  const LubricantOf<Parameter>& oil = law.lubricant;
  const WithSlope<Real> viscosity =
      log_vogel_viscosity(law.log_vogel_prefactor, oil.vogel_temperature_coefficient,
                          oil.vogel_reference_temperature, temperature);
  LogStress<Real> out;
  out.factor = roelands_factor(viscosity.value);
  out.factor_slope = out.base_slope = viscosity.slope;
  out.base = viscosity.value + log_shear_rate;
  if (law.newtonian) return out;

  const Real density =
      linear_density(oil.density_at_zero_kelvin, oil.density_temperature_slope, temperature);
  const Real heat_density = temperature * density;
  const Real shift = log_time_temperature_shift(viscosity.value, logarithm<kDigits>(heat_density),
                                                law.shift_reference);
  const Real power = thinning_power<kDigits>(oil.havriliak_negami_alpha,
                                             shift + law.log_relaxation_time + log_shear_rate);
  const Real sum = power + 1;
  out.base = out.base - log_thinning<kDigits>(oil.havriliak_negami_beta, sum);  // (eq 23)
  // d ln F/d ln(lambda a_TTS gamma_dot), and d ln(T rho)/dT.
  const Parameter steepest = oil.havriliak_negami_alpha * oil.havriliak_negami_beta;
  Real steepness, heat_density_slope;
  if (kDigits == Digits::kHalf) {
    steepness = steepest * (power / sum);
    heat_density_slope = law.coarse_heat_density_slope;
  } else {  // one division for two quotients
    const Real per_both = 1 / (heat_density * sum);
    steepness = steepest * power * (heat_density * per_both);
    heat_density_slope =
        fused(oil.density_temperature_slope, temperature, density) * (sum * per_both);
  }
  out.base_slope = less_product(steepness, viscosity.slope - heat_density_slope, viscosity.slope);
  return out;
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_LAWS_SHEAR_INL_H_
