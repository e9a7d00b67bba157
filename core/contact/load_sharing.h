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

/// The root of W_EHL + W_asp(W_EHL) = W, solved for ln(W_EHL/W), so that tiny film loads keep their
/// digits. With the exact F_5/2 and the ellipse from W_EHL there is always one and only one. With
/// the ellipse from the total load the asperities alone may carry more than W: not found. With the
/// polynomials roots may be missing or several: the one nearest to W_EHL = W.
SharedLoad solve_load_sharing(const LoadSharing& sharing);

}  // namespace tribodyn
