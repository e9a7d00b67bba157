#pragma once

#include <cmath>
#include <type_traits>

#include "core/laws/laws.h"
#include "core/model_options.h"
#include "core/surface/surface.h"

namespace tribodyn {

/// Shape of a Hertzian ellipse, a function of the ratio of the effective radii alone.
template <class Real>
struct HertzFitOf {
  Real ellipticity;      ///< k_bar = a_c/b_c, semi-major over semi-minor axis [-]
  Real second_integral;  ///< eps_bar, complete elliptic integral of the second kind [-]
};
using HertzFit = HertzFitOf<double>;

/// Semi axes and greatest pressure of a Hertzian ellipse.
template <class Real>
struct EllipseAxesOf {
  Real semi_major;        ///< a_c, along the larger effective radius [m]
  Real semi_minor;        ///< b_c, along the smaller effective radius [m]
  Real maximum_pressure;  ///< p_max = 3 W/(2 pi a_c b_c), eq 19 at the centre [Pa]
};
using EllipseAxes = EllipseAxesOf<double>;

/// The same for a load of 1 N; each member grows with the cube root of the load.
template <class Real>
using UnitLoadEllipseOf = EllipseAxesOf<Real>;
using UnitLoadEllipse = UnitLoadEllipseOf<double>;

/// Effective radii of a pair of bodies whose principal axes are aligned with x and y.
struct EffectiveRadii {
  double x;  ///< R_zx [m]
  double y;  ///< R_zy [m]
};

/// E' of eq 13 [Pa] of two bodies of the same material: E/(1 - nu^2), which is 2 E* in Johnson's
/// notation. youngs_modulus [Pa] > 0, poissons_ratio in (-1, 0.5].
double reduced_modulus(double youngs_modulus, double poissons_ratio);

/// E' of two bodies [Pa].
template <class Real>
Real reduced_modulus(const SolidPairOf<Real>& solids) {
  const auto compliance = [](const SolidOf<Real>& solid) {
    return (1 - solid.poissons_ratio * solid.poissons_ratio) / solid.youngs_modulus;
  };
  return laws::reduced_modulus(compliance(solids.body_1), compliance(solids.body_2));
}

/// Effective radii, 1/R_x = 1/R_1x + 1/R_2x and the same for y [m]. A radius is positive where the
/// body is convex, negative where it is hollow, infinite where it is flat.
/// Throws Refusal RADIUS_NOT_A_RADIUS (zero or NaN) or CONTACT_NOT_A_POINT (a sum of curvatures
/// is not positive: the bodies conform, and Hertz's theory of a point contact does not apply).
EffectiveRadii effective_radii(double radius_1x, double radius_1y, double radius_2x,
                               double radius_2y);

/// Eqs 21 and 22 with r = max(R_x, R_y)/min(R_x, R_y):
///
///   k_bar = 1.0339 r^0.636,     eps_bar = 1.0003 + 0.5968/r.
///
/// The paper prints eps_bar with the inverse ratio (as_published.eq22_inverted_ratio), which makes
/// p_max 30 % low at r = 2 and 87 % low at r = 33 (46 % and 95 % with eq 20 as printed too).
/// Against exact_ellipticity for r in 1..100: k_bar within 6.4 %, eps_bar within 1.7 %, p_max
/// within 2.2 %; k_bar is 1.0339, not 1, at r = 1.
///
/// radius_x, radius_y [m] > 0 and finite (not checked).
/// Source: B. J. Hamrock and D. Brewe, J. Lubr. Technol. 105 (1983) 171-177.
template <class Real>
HertzFitOf<Real> simplified_ellipticity(std::type_identity_t<Real> radius_x, Real radius_y,
                                        const AsPublished& as_published) {
  const Real ratio = radius_x < radius_y ? radius_y / radius_x : radius_x / radius_y;
  return {laws::simplified_ellipticity(ratio),
          laws::simplified_second_integral(as_published.eq22_inverted_ratio ? ratio : 1 / ratio)};
}

/// The exact ellipticity: the root k >= 1 of Hertz's relation
///
///   r = (k^2 E(m) - K(m))/(K(m) - E(m)),   m = 1 - 1/k^2,   r = max(R_x, R_y)/min(R_x, R_y),
///
/// and E(m), to machine precision (relative error below 3e-15 for r up to 1e6, 1e-13 for any r);
/// exactly 1 and pi/2 at r = 1. radius_x, radius_y [m] > 0 and finite, otherwise NaN. Costs about
/// 2 us: keep the result, it does not depend on load.
/// Source: K. L. Johnson, Contact Mechanics (1985), section 4.2; integrals by B. C. Carlson,
/// Numer. Algorithms 10 (1995) 13-26.
HertzFit exact_ellipticity(double radius_x, double radius_y);

template <int kCount>
HertzFitOf<laws::Dual<double, kCount>> exact_ellipticity(
    const laws::Dual<double, kCount>& radius_x, const laws::Dual<double, kCount>& radius_y) {
  const HertzFit fit = exact_ellipticity(radius_x.value, radius_y.value);
  const auto log_ratio =
      laws::logarithm(radius_x < radius_y ? radius_y / radius_x : radius_x / radius_y);
  const auto shape =
      laws::ellipse_shape(laws::Dual<double, 1>::variable(std::log(fit.ellipticity), 0));
  const double log_k_slope = 1 / shape.log_ratio.slope[0];
  return {chained(fit.ellipticity, fit.ellipticity * log_k_slope, log_ratio),
          chained(fit.second_integral, shape.second_integral.slope[0] * log_k_slope, log_ratio)};
}

/// Eq 20 for a load of 1 N with R' = R_x R_y/(R_x + R_y) (called R_e in the paper, but not the R_e
/// of eq 15):
///
///   a_c = (6 k^2 eps W R'/(pi E'))^(1/3),     b_c = (6 eps W R'/(pi k E'))^(1/3).
///
/// The paper prints (k eps)^2 in a_c (as_published.eq20_semi_major).
/// Radii [m], reduced_modulus E' [Pa]; all positive (not checked).
template <class Real>
UnitLoadEllipseOf<Real> unit_load_ellipse(const HertzFitOf<Real>& fit,
                                          std::type_identity_t<Real> radius_x,
                                          std::type_identity_t<Real> radius_y,
                                          std::type_identity_t<Real> reduced_modulus,
                                          const AsPublished& as_published) {
  const Real k = fit.ellipticity;
  const Real volume = laws::hertz_volume(radius_x, radius_y, reduced_modulus);
  UnitLoadEllipseOf<Real> unit_load;
  unit_load.semi_minor = laws::semi_axis(volume, k, fit.second_integral);
  unit_load.semi_major = as_published.eq20_semi_major
                             ? laws::cube_root(volume * laws::square(k * fit.second_integral))
                             : k * unit_load.semi_minor;
  unit_load.maximum_pressure =
      laws::maximum_pressure(Real(1.0), unit_load.semi_major, unit_load.semi_minor);
  return unit_load;
}

/// The ellipse under a load W [N] >= 0: one cube root.
template <class Real>
EllipseAxesOf<Real> ellipse_axes(const UnitLoadEllipseOf<Real>& unit_load, Real load) {
  const Real root = laws::cube_root(load);
  return {unit_load.semi_major * root, unit_load.semi_minor * root,
          unit_load.maximum_pressure * root};
}

}  // namespace tribodyn
