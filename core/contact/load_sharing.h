#pragma once

#include "core/contact/asperity_functions.h"
#include "core/laws/laws.h"

namespace tribodyn {

/// How eq 41 divides a load between film and asperities, with eq 12 (h ~ W^-0.073) and eq 20
/// (A ~ W^(2/3)) inside: all follows from what would be if the film carried all.
template <class Real>
struct LoadSharingOf {
  Real load;                      ///< W [N] > 0
  Real film_ratio_under_all;      ///< lambda_s if W_EHL were W [-]
  Real asperity_load_per_f5_2;    ///< W_asp / F_5/2 if W_EHL were W [N]
  bool ellipse_from_total_load;   ///< A does not follow W_EHL
  bool as_published_polynomials;  ///< eq 43 as printed
  bool closed = false;            ///< ModelOptions::closed_load_sharing, where it has an effect
};
using LoadSharing = LoadSharingOf<double>;

template <class Real>
AsperityFunctionsOf<Real> asperity_functions(Real film_ratio, bool as_published_polynomials) {
  if (!as_published_polynomials) return asperity_functions(film_ratio);
  return {laws::f2_as_published(film_ratio), laws::f5_2_as_published(film_ratio)};
}

/// (W_EHL + W_asp)/W at r = ln(W_EHL/W).
template <class Real>
Real carried_share(const LoadSharingOf<Real>& in, Real r) {
  const Real film_ratio = in.film_ratio_under_all * laws::film_thinning(r);
  const Real share = laws::exponential(r);
  Real asperities = in.asperity_load_per_f5_2 / in.load *
                    asperity_functions(film_ratio, in.as_published_polynomials).f5_2;
  if (!in.ellipse_from_total_load) asperities = asperities * laws::exponential(2.0 / 3 * r);
  return share + asperities;
}

struct SharedLoad {
  bool found;
  double log_share;  ///< ln(W_EHL/W)
};

/// The root of W_EHL + W_asp(W_EHL) = W (K. L. Johnson, J. A. Greenwood and S. Y. Poon, Wear 19,
/// 1972, 91; asperities after J. A. Greenwood and J. H. Tripp, Proc. IMechE 185, 1970, 625):
///  1. The unknown is r = ln(W_EHL/W) <= 0, so that tiny film loads keep their digits, and the
///     function g(r) = ln((W_EHL + W_asp)/W), which is nearly linear and rises.
///  2. With the ellipse from W_EHL the slope of g is at least 2/3, so that r >= -1.5 g(0) closes
///     the bracket: there is one root and only one. Otherwise the lower end is doubled until g < 0;
///     the asperities alone may carry more than W: not found.
///  3. Newton's method, safeguarded by bisection (numerics/bracketed_root.h), from r = 0.
/// With the polynomials as published roots may be missing or several: r from 3 down to -30 is
/// scanned in steps of 1/64, and the root nearest to W_EHL = W is returned.
SharedLoad solve_load_sharing(const LoadSharing& sharing);

}  // namespace tribodyn
