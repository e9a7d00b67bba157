#pragma once

#include "core/laws/laws.h"

namespace tribodyn {

/// F_2 and F_5/2 at one film ratio.
template <class Real>
struct AsperityFunctionsOf {
  Real f2 = 0.0;    ///< F_2, asperity area (eq 42) [-]
  Real f5_2 = 0.0;  ///< F_5/2, asperity load (eq 41) [-]
};
using AsperityFunctions = AsperityFunctionsOf<double>;

/// The Greenwood-Tripp integrals over a Gaussian distribution of summit heights,
///
///   F_n(l) = (2 pi)^(-1/2) int_l^inf (s - l)^n exp(-s^2/2) ds,      n = 2, 5/2,
///
/// of the separation of the mean planes over sigma_G, which is lambda_s = h_cen/sigma_G [-] in
/// eqs 41 and 42. They replace the polynomials of eqs 43 and 44, which are up to 28 % off at l = 2
/// and negative soon after.
///
/// Valid for any l, negative where one mean plane is pressed below the other; NaN for NaN (nothing
/// is thrown: this is the innermost law of the contact kernel). Relative error below 3e-15 wherever
/// the result is a normal number (l < 37.2); beyond, the result is within rounding of a subnormal
/// number and from l = 38.75 on exactly 0. The first call builds a table (a few ms, thread safe).
///
/// Source: J. A. Greenwood and J. H. Tripp, Proc. IMechE 185 (1970-71) 625-633.
AsperityFunctions asperity_functions(double film_ratio);

/// The same with derivatives by the film ratio, -n F_{n-1}, of 1e-12 (relative).
AsperityFunctionsOf<laws::Dual<double, 1>> asperity_functions_and_slopes(double film_ratio);

template <int kCount>
AsperityFunctionsOf<laws::Dual<double, kCount>> asperity_functions(
    const laws::Dual<double, kCount>& film_ratio) {
  const auto f = asperity_functions_and_slopes(film_ratio.value);
  return {chained(f.f2.value, f.f2.slope[0], film_ratio),
          chained(f.f5_2.value, f.f5_2.slope[0], film_ratio)};
}

/// The l at which F_5/2 has a value above 0 and at most F_5/2(above), to rounding: how far
/// asperities approach to carry a load.
double separation_under_load(double f5_2, double above);

template <int kCount>
laws::Dual<double, kCount> separation_under_load(const laws::Dual<double, kCount>& f5_2,
                                                 double above) {
  const double l = separation_under_load(f5_2.value, above);
  return chained(l, 1 / asperity_functions_and_slopes(l).f5_2.slope[0], f5_2);
}

}  // namespace tribodyn
