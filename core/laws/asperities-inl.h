// Load, area and friction of asperities.
// Templates on their number type, compiled per instruction set too: see core/laws/laws.h.
#if defined(TRIBODYN_CORE_LAWS_ASPERITIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_LAWS_ASPERITIES_INL_H_
#undef TRIBODYN_CORE_LAWS_ASPERITIES_INL_H_
#else
#define TRIBODYN_CORE_LAWS_ASPERITIES_INL_H_
#endif

#include <hwy/highway.h>

#include <numbers>

#include "core/numerics/real-inl.h"
#include "core/surface/surface.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

/// W_asp/(A_EHL F_5/2) [Pa] of a surface on bodies of E' [Pa] (J. A. Greenwood and J. H. Tripp,
/// Proc. IMechE 185 (1970-71) 625-633).
template <class Real>
HWY_INLINE Real asperity_load_factor(const RoughnessOf<Real>& surface, Real modulus) {
  const Real product =
      surface.asperity_density * surface.asperity_radius * surface.composite_rms_height;
  return 8 * std::numbers::sqrt2 / 15 * std::numbers::pi * square(product) *
         root(surface.composite_rms_height / surface.asperity_radius) * modulus;  // (eq 41)
}

/// A_asp/(A_EHL F_2) [-].
template <class Real>
HWY_INLINE Real asperity_area_factor(const RoughnessOf<Real>& surface) {
  const Real product =
      surface.asperity_density * surface.asperity_radius * surface.composite_rms_height;
  return std::numbers::pi * std::numbers::pi * square(product);  // (eq 42)
}

/// F_5/2 and F_2 of the film ratio as fitted polynomials. Against the exact integrals
/// (core/contact/asperity_functions.h) they are within 2 % only below 1.4, and negative from 2.224
/// and 2.294: asperities that pull. Nothing is clipped.
template <class Real>
HWY_INLINE Real f5_2_as_published(Real l) {
  return ((((-0.0046 * l + 0.0574) * l - 0.2958) * l + 0.7844) * l - 1.0776) * l +
         0.6167;  // (eq 43)
}
template <class Real>
HWY_INLINE Real f2_as_published(Real l) {
  return ((((-0.0018 * l + 0.0281) * l - 0.1728) * l + 0.5258) * l - 0.8043) * l +
         0.5003;  // (eq 44)
}

/// Largest share of a load that a film of this ratio h_cen/sigma_G supports [-]: 1 from 1.128 on, 0
/// without a film. Fitted to the friction of spur gears, for Lambda = h_0/Ra: asperities carry
/// (1 - Lambda/2)^2 below 2 (J. Doleschel, dissertation, TU Munich, 2003). Ra is the mean of both
/// flanks, which is sigma_G/sqrt(pi) of equal Gaussian surfaces. Eq 12 alone lets the thinnest film
/// carry any load, because its thickness hardly depends on the load.
template <class Real>
HWY_INLINE Real supported_share(Real film_ratio) {
  const double half = 0.5 / std::numbers::inv_sqrtpi;  // of Lambda over the film ratio
  const Real x = least(half * film_ratio, Real(1.0));
  return x * (2.0 - x);
}

/// F_b [N] from tau_0 [Pa], A_asp [m2], zeta [-] and W_asp [N].
template <class Parameter, class Real>
HWY_INLINE Real boundary_friction(Parameter shear_strength, Real area, Parameter coefficient,
                                  Real load) {
  return fused(shear_strength, area, coefficient * load);  // (eq 40)
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_LAWS_ASPERITIES_INL_H_
