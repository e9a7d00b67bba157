#pragma once

namespace tribodyn {

/// How eq 41 divides a load between film and asperities, with eq 12 (h ~ W^-0.073) and eq 20
/// (A ~ W^(2/3)) inside: everything is known from its value when the film carries all.
struct LoadSharing {
  double load;                    ///< W [N] > 0
  double film_ratio_under_all;    ///< lambda_s if W_EHL were W [-]
  double asperity_load_per_f5_2;  ///< W_asp / F_5/2 if W_EHL were W [N]
  bool ellipse_from_total_load;   ///< A does not follow W_EHL
  bool as_published_polynomials;  ///< eq 43 as printed
};

struct SharedLoad {
  bool found;
  double film_load;  ///< W_EHL [N]
};

/// The root of W_EHL + W_asp(W_EHL) = W, solved for ln(W_EHL/W), so that tiny film loads keep their
/// digits. With the exact F_5/2 and the ellipse from W_EHL there is always one and only one. With
/// the ellipse from the total load the asperities alone may carry more than W: not found. With the
/// polynomials roots may be missing or several: the one nearest to W_EHL = W.
SharedLoad solve_load_sharing(const LoadSharing& sharing);

}  // namespace tribodyn
