#pragma once

namespace tribodyn {

/// F_2 and F_5/2 at one film ratio.
struct AsperityFunctions {
  double f2 = 0;    ///< F_2, asperity area (eq 42) [-]
  double f5_2 = 0;  ///< F_5/2, asperity load (eq 41) [-]
};

/// The Greenwood-Tripp integrals over a Gaussian distribution of summit heights,
///
///   F_n(l) = (2 pi)^(-1/2) int_l^inf (s - l)^n exp(-s^2/2) ds,      n = 2, 5/2,
///
/// of the film ratio l = lambda_s = h_cen/sigma_G [-] in eqs 41 and 42. They stand in place of the
/// polynomials of eqs 43, 44, which are up to 28 % off at l = 2 and negative soon after.
///
/// Valid for 0 <= l <= +inf; NaN for a negative or NaN argument (nothing is thrown: this is the
/// innermost law of the contact kernel). Relative error below 3e-15 wherever the result is a normal
/// number (l < 37.2); beyond, the result is within rounding of a subnormal number and
/// from l = 38.75 on exactly 0. The first call builds a table (a few ms, thread safe).
///
/// Source: J. A. Greenwood and J. H. Tripp, Proc. IMechE 185 (1970-71) 625-633.
AsperityFunctions asperity_functions(double film_ratio);

/// F_2 alone; see asperity_functions.
double asperity_function_2(double film_ratio);

/// F_5/2 alone; see asperity_functions.
double asperity_function_5_2(double film_ratio);

/// The fitted polynomials as printed in eqs 43 (F_5/2) and 44 (F_2), for any film ratio [-].
/// Printed without a range. Against the exact integrals they are within 2 % only for l < 1.4, and
/// negative from l = 2.224 (F_5/2) and 2.294 (F_2): asperities that pull. Nothing is clipped here.
AsperityFunctions asperity_functions_as_published(double film_ratio);

}  // namespace tribodyn
