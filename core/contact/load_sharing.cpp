#include "core/contact/load_sharing.h"

#include <cmath>
#include <limits>

#include "core/numerics/bracketed_root.h"

namespace tribodyn {
namespace {

/// Scan of the polynomials' balance over W_EHL/W in (e^-30, e^3): they need not be monotone.
SharedLoad solve_as_published(const LoadSharing& in) {
  const auto excess = [&](double r) { return carried_share(in, r) - 1; };
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
        nearest = {true, r};
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

  // ln of the share, which rises with r; root in r <= 0.
  using Number = laws::Dual<double, 1>;
  const LoadSharingOf<Number> dual{in.load, in.film_ratio_under_all, in.asperity_load_per_f5_2,
                                   in.ellipse_from_total_load, false};
  const auto balance = [&](double r) {
    const Number excess = logarithm(carried_share(dual, Number::variable(r, 0)));
    return ValueAndSlope{excess.value, excess.slope[0]};
  };
  const ValueAndSlope all = balance(0);
  if (all.value <= 0) return {true, 0};
  double lower = in.ellipse_from_total_load ? -1 : -1.5 * all.value - 1e-12;
  // With the ellipse from W_EHL the slope is at least 2/3, which closes the bracket unseen.
  while (in.ellipse_from_total_load && balance(lower).value > 0) {
    lower *= 2;
    if (lower < -2000) return {false, 0};
  }
  const double r = safeguarded_newton(balance, lower, 0, -all.value / all.slope, true);
  return {true, r};
}

}  // namespace tribodyn
