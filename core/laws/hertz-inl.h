// The ellipse of a point contact.
// Templates on their number type, compiled per instruction set too: see core/laws/laws.h.
#if defined(TRIBODYN_CORE_LAWS_HERTZ_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_LAWS_HERTZ_INL_H_
#undef TRIBODYN_CORE_LAWS_HERTZ_INL_H_
#else
#define TRIBODYN_CORE_LAWS_HERTZ_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numerics/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

/// k_bar = a_c/b_c from r = max(R_x, R_y)/min(R_x, R_y) (B. J. Hamrock and D. Brewe, J. Lubr.
/// Technol. 105 (1983) 171-177).
template <class Real>
HWY_INLINE Real simplified_ellipticity(Real ratio) {
  return 1.0339 * exponential(0.636 * logarithm(ratio));  // (eq 21)
}

/// eps_bar, which goes with it, from 1/r. The paper prints it with r.
template <class Real>
HWY_INLINE Real simplified_second_integral(Real inverse_ratio) {
  return 1.0003 + 0.5968 * inverse_ratio;  // (eq 22)
}

/// 6 W R'/(pi E') at W = 1 N, R' = R_x R_y/(R_x + R_y) (called R_e in the paper, but not the R_e of
/// eq 15).
template <class Real>
HWY_INLINE Real hertz_volume(Real radius_x, Real radius_y, Real modulus) {
  return 6 * (radius_x * radius_y / (radius_x + radius_y)) / (std::numbers::pi * modulus);
}

/// b_c from that volume, and a_c from it times k^3.
template <class Real>
HWY_INLINE Real semi_axis(Real volume, Real ellipticity, Real second_integral) {
  return cube_root(volume * second_integral / ellipticity);  // (eq 20)
}

/// p_max [Pa], the pressure at the centre; it is p_max sqrt(1 - (x/b_c)^2 - (y/a_c)^2) elsewhere.
template <class Real>
HWY_INLINE Real maximum_pressure(Real load, Real semi_major, Real semi_minor) {
  return 1.5 * load / (std::numbers::pi * semi_major * semi_minor);  // (eq 19)
}

/// Carlson's symmetric integral R_D(x, y, z) by duplication (DLMF 19.26.23, 19.36.2): the arguments
/// draw together by a factor of four per step, then a series of fifth order ends it. Not for packs.
/// x, y >= 0, at most one of them 0, z > 0.
template <class Real>
Real carlson_rd(Real x, Real y, Real z) {
  constexpr double kCloseness = 6e-4;  // error of the series 3 kCloseness^6: below 1e-18
  Real sum = 0.0, mean, dx, dy, dz;
  double scale = 1;
  for (;;) {
    mean = (x + y + 3 * z) / 5;
    dx = (mean - x) / mean;
    dy = (mean - y) / mean;
    dz = (mean - z) / mean;
    if (std::max({std::abs(value_of(dx)), std::abs(value_of(dy)), std::abs(value_of(dz))}) <
        kCloseness) {
      break;
    }
    const Real root_x = value_of(x) == 0 ? Real(0.0) : root(x);
    const Real root_y = root(y);
    const Real root_z = root(z);
    const Real shift = root_x * root_y + root_y * root_z + root_z * root_x;
    sum = sum + scale / (root_z * (z + shift));
    scale /= 4;
    x = (x + shift) / 4;
    y = (y + shift) / 4;
    z = (z + shift) / 4;
  }
  const Real xy = dx * dy;
  const Real zz = dz * dz;
  const Real e2 = xy - 6 * zz;
  const Real e3 = (3 * xy - 8 * zz) * dz;
  const Real e4 = 3 * (xy - zz) * zz;
  const Real e5 = xy * zz * dz;
  const Real series =
      1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 - 9 * e2 * e3 / 52 + 3 * e5 / 26;
  return 3 * sum + scale * series / (mean * root(mean));
}

/// ln r = ln((k^2 E(m) - K(m))/(K(m) - E(m))), m = 1 - 1/k^2, and E(m), from ln k >= 0; not for
/// packs. With q = 1 - m: K - E = (m/3) R_D(0, q, 1) and E - q K = (m q/3) R_D(0, 1, q) (DLMF
/// 19.25.1). So nothing cancels in
///   r = R_D(0, 1, q)/R_D(0, q, 1),   E = (q/3) (R_D(0, 1, q) + R_D(0, q, 1)).
/// Beyond k = e^40 they are 2 ln k - ln(ln 4k - 1) and 1 to the last bit, and q would underflow.
/// Source: K. L. Johnson, Contact Mechanics (1985), section 4.2; integrals by B. C. Carlson, Numer.
/// Algorithms 10 (1995) 13-26.
template <class Real>
struct EllipseShape {
  Real log_ratio;
  Real second_integral;
};
template <class Real>
EllipseShape<Real> ellipse_shape(Real log_k) {
  if (value_of(log_k) > 40) {
    return {2 * log_k - logarithm(log_k + (std::log(4.0) - 1)), Real(1.0)};
  }
  const Real q = exponential(-2 * log_k);
  const Real along = carlson_rd(Real(0.0), Real(1.0), q);
  const Real across = carlson_rd(Real(0.0), q, Real(1.0));
  return {logarithm(along / across), q / 3 * (along + across)};
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_LAWS_HERTZ_INL_H_
