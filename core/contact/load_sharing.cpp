#include "core/contact/load_sharing.h"

#include <cmath>
#include <limits>

#include "core/contact/asperity_functions.h"
#include "core/numerics/bracketed_root.h"

namespace tribodyn {
namespace {

constexpr double kFilmLoadExponent = -0.073;

/// Scan of the polynomials' balance over W_EHL/W in (e^-30, e^3): they need not be monotone.
SharedLoad solve_as_published(const LoadSharing& in) {
  const double area_exponent = in.ellipse_from_total_load ? 0 : 2.0 / 3;
  const auto excess = [&](double r) {
    const double ratio = in.film_ratio_under_all * std::exp(kFilmLoadExponent * r);
    return std::exp(r) - 1 +
           in.asperity_load_per_f5_2 / in.load * std::exp(area_exponent * r) *
               asperity_functions_as_published(ratio).f5_2;
  };
  constexpr double kStep = 1.0 / 64;
  SharedLoad nearest{false, 0};
  double distance = std::numeric_limits<double>::infinity();
  double right = 3, f_right = excess(right);
  while (right > -30) {
    const double left = right - kStep, f_left = excess(left);
    if ((f_left <= 0) != (f_right <= 0)) {
      const double r = bracketed_root(excess, left, right, f_left, f_right);
      if (std::abs(r) < distance) {
        distance = std::abs(r);
        nearest = {true, in.load * std::exp(r)};
      }
    }
    right = left;
    f_right = f_left;
  }
  return nearest;
}

}  // namespace

SharedLoad solve_load_sharing(const LoadSharing& in) {
  if (in.as_published_polynomials) return solve_as_published(in);

  // g(r) = ln(e^r + w_asp(r)), r = ln(W_EHL/W); rising; root in r <= 0.
  const double area_exponent = in.ellipse_from_total_load ? 0 : 2.0 / 3;
  const double scale = in.asperity_load_per_f5_2 / in.load;
  const auto balance = [&](double r) {
    const double ratio = in.film_ratio_under_all * std::exp(kFilmLoadExponent * r);
    const AsperityFunctions f = asperity_functions(ratio);
    const double film = std::exp(r), asperities = scale * std::exp(area_exponent * r) * f.f5_2;
    // d ln F_5/2 / d lambda = -2.5 F_3/2 / F_5/2; F_n / Gamma(n+1) is log-concave in n, so F_3/2
    // comes from F_2 and F_5/2 to a few percent: enough for a slope.
    double log_slope = 0;
    if (f.f5_2 > 0) {
      constexpr double kGammas = 1.329340388179137 * 3.323350970447843 / 4;
      log_slope = 2.5 * kGammas * (f.f2 / f.f5_2) * (f.f2 / f.f5_2) * ratio * -kFilmLoadExponent;
    }
    return ValueAndSlope{std::log(film + asperities),
                         (film + asperities * (area_exponent + log_slope)) / (film + asperities)};
  };
  const ValueAndSlope all = balance(0);
  if (all.value <= 0) return {true, in.load};
  double lower = area_exponent > 0 ? -1.5 * all.value - 1e-12 : -1;
  // With the ellipse from W_EHL the slope is at least 2/3, which closes the bracket unseen.
  while (area_exponent == 0 && balance(lower).value > 0) {
    lower *= 2;
    if (lower < -2000) return {false, 0};
  }
  const double r = safeguarded_newton(balance, lower, 0, -all.value / all.slope, true);
  return {true, in.load * std::exp(r)};
}

}  // namespace tribodyn
