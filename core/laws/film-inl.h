// Central film thickness of a point contact.
// Templates on their number type, compiled per instruction set too: see core/laws/laws.h.
#if defined(TRIBODYN_CORE_LAWS_FILM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_LAWS_FILM_INL_H_
#undef TRIBODYN_CORE_LAWS_FILM_INL_H_
#else
#define TRIBODYN_CORE_LAWS_FILM_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

#include "core/numerics/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

// Eq 12 with the groups of eq 13 written out is a product of powers, so its logarithm is a sum:
//
//   ln h = ln(4.31 (eta_0/E')^0.68 (alpha* E')^0.49 E'^0.073) + 0.68 ln U_eff
//          + (1 - 0.68 + 2 0.073) ln R_e - 0.073 ln W + ln side_leakage.
//
// A regression of smooth, fully flooded, isothermal, Newtonian solutions with an error of several
// percent. Source: R. J. Chittenden, D. Dowson, J. F. Dunn, C. M. Taylor, Proc. R. Soc. Lond. A 397
// (1985) 245-269 (part I) and 271-294 (part II, entrainment at an angle to the axes).
constexpr double kFilmFactor = 4.31;
constexpr double kFilmSpeedExponent = 0.68;
constexpr double kFilmMaterialExponent = 0.49;
constexpr double kFilmLoadExponent = 0.073;  ///< of 1/W_e
constexpr double kFilmRadiusExponent = 1 - kFilmSpeedExponent + 2 * kFilmLoadExponent;
constexpr double kSideLeakageFactor = 1.23;

/// E' [Pa] of two bodies from (1 - nu^2)/E of each [1/Pa], twice Johnson's E*: E/(1 - nu^2) where
/// both are of one material.
template <class Real>
HWY_INLINE Real reduced_modulus(Real compliance_1, Real compliance_2) {
  return 2 / (compliance_1 + compliance_2);  // (eq 13)
}

/// 1/R_e [1/m], the curvature along the entrainment, from the squares of the cosine and the sine of
/// theta. From U^2 and V^2 instead: U_eff^2/R_e.
template <class Real>
HWY_INLINE Real curvature_along_entrainment(Real cosine2, Real sine2, Real curvature_x,
                                            Real curvature_y) {
  return fused(cosine2, curvature_x, sine2 * curvature_y);  // (eq 15)
}

/// 1/R_s [1/m], the curvature across the entrainment, from the same.
template <class Real>
HWY_INLINE Real curvature_across_entrainment(Real cosine2, Real sine2, Real curvature_x,
                                             Real curvature_y) {
  return fused(sine2, curvature_x, cosine2 * curvature_y);  // (eq 16)
}

/// U_eff^2 [m2/s2] from U^2 and V^2: with theta = atan2(V, U), U cos(theta) + V sin(theta) =
/// sqrt(U^2 + V^2). The paper's theta = atan(V/U) gives its negative where U < 0.
template <class Real>
HWY_INLINE Real entrainment_speed_squared(Real mean_x2, Real mean_y2) {
  return mean_x2 + mean_y2;  // (eq 17)
}

/// The part of ln h that depends on the lubricant at the inlet and on E' alone.
template <class Real>
HWY_INLINE Real log_film_constant(Real log_viscosity, Real log_coefficient, Real log_modulus) {
  return std::log(kFilmFactor) + kFilmSpeedExponent * (log_viscosity - log_modulus) +
         kFilmMaterialExponent * (log_coefficient + log_modulus) + kFilmLoadExponent * log_modulus;
}

/// ln h_cen [m] but for the side leakage, from that part, ln U_eff^2, ln(1/R_e) and ln W of the
/// film's load.
template <class Constant, class Real>
HWY_INLINE Real log_film(Constant log_constant, Real log_speed2, Real log_curvature,
                         Real log_load) {
  Real sum = fused(kFilmSpeedExponent / 2, log_speed2, log_constant);
  sum = less_product(kFilmRadiusExponent, log_curvature, sum);
  return less_product(kFilmLoadExponent, log_load, sum);  // (eq 12)
}

/// 1 - exp(-1.23 (R_s/R_e)^(2/3)) of eq 12 from ln(R_s/R_e).
template <class Real>
HWY_INLINE Real side_leakage(Real log_radius_ratio) {
  const Real power = exponential((2.0 / 3) * log_radius_ratio);
  return -exponential_less_one(greatest(-kSideLeakageFactor * power, -600));
}

/// h_cen(W)/h_cen(W_0) from ln(W/W_0).
template <class Real>
HWY_INLINE Real film_thinning(Real log_load_ratio) {
  return exponential(-kFilmLoadExponent * log_load_ratio);
}

/// gamma_dot [1/s] of Couette flow.
template <class Real>
HWY_INLINE Real shear_rate(Real sliding_speed, Real film_thickness) {
  return sliding_speed / film_thickness;  // (eq 18)
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_LAWS_FILM_INL_H_
