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

/// h_min/h_cen from ln(R_s/R_e), not an equation of the paper: the same source has the minimum film
/// with 3.68 and 0.67 in place of 4.31 and 1.23, and with the same powers of speed, load and
/// material, so that only the side leakage differs.
template <class Real>
HWY_INLINE Real minimum_film_share(Real log_radius_ratio) {
  const Real power = exponential((2.0 / 3) * log_radius_ratio);
  return 3.68 / kFilmFactor * exponential_less_one(greatest(-0.67 * power, -600)) /
         exponential_less_one(greatest(-kSideLeakageFactor * power, -600));
}

/// h_cen(W)/h_cen(W_0) from ln(W/W_0).
template <class Real>
HWY_INLINE Real film_thinning(Real log_load_ratio) {
  return exponential(-kFilmLoadExponent * log_load_ratio);
}

/// ln(beta eta_0/k_f) [ln(s2/m2)], the part of the thermal loading L = beta eta_0 U_eff^2/k_f that
/// depends on the lubricant at the inlet alone, from ln eta_0, beta = -d ln eta_0/dT [1/K] and k_f
/// [W/(m K)].
template <class Real>
HWY_INLINE Real log_thermal_loading(Real log_viscosity, Real log_viscosity_fall,
                                    Real conductivity) {
  return log_viscosity + logarithm(log_viscosity_fall / conductivity);
}

/// phi_T, h_cen where shear heats the inlet over h_cen where it does not, not an equation of the
/// paper:
///
///   phi_T = (1 - 13.2 (p_0/E') L^0.42)/(1 + 0.213 (1 + 2.23 S^0.83) L^0.64),   S = V_s/U_eff,
///
/// with p_0 [Pa] the greatest pressure. S is the slide-roll ratio, not the sliding speed. A
/// regression; its numerator is held at 1/2 from below, because it would fall through 0 for oils so
/// cold that L exceeds some hundreds. Source: P. K. Gupta, H. S. Cheng, D. Zhu, N. H. Forster, J.
/// B. Schrand, Tribol. Trans. 35 (1992) 269-274, as later works cite it.
constexpr double kLeastInletNumerator = 0.5;  ///< of phi_T [-], assumed
template <class Constant, class Real, class Modulus>
HWY_INLINE Real inlet_heating_factor(Constant log_thermal_loading, Real log_speed2, Real log_slide2,
                                     Real maximum_pressure, Modulus modulus) {
  const Real log_loading = log_speed2 + log_thermal_loading;
  const Real slide = exponential(0.83 / 2 * (log_slide2 - log_speed2));
  const Real compressed = maximum_pressure / modulus * exponential(0.42 * log_loading);
  const Real sheared = (1 + 2.23 * slide) * exponential(0.64 * log_loading);
  return greatest(1 - 13.2 * compressed, kLeastInletNumerator) / (1 + 0.213 * sheared);
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
