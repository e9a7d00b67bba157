#include "core/contact/hertz.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

double ratio_of_radii(double radius_x, double radius_y) {
  return std::max(radius_x, radius_y) / std::min(radius_x, radius_y);
}

}  // namespace

double reduced_modulus(double youngs_modulus, double poissons_ratio) {
  return reduced_modulus(SolidPair(Solid{youngs_modulus, poissons_ratio, 0, 0, 0}));
}

EffectiveRadii effective_radii(double radius_1x, double radius_1y, double radius_2x,
                               double radius_2y) {
  const auto effective = [](double first, double second, const std::string& direction) {
    if (!(first != 0) || !(second != 0) || std::isnan(first) || std::isnan(second)) {
      throw Refusal("RADIUS_NOT_A_RADIUS",
                    "Radii of curvature along " + direction + " of " + number_text(first) +
                        " m and " + number_text(second) + " m: a radius must not be zero or NaN.");
    }
    const double curvature = 1 / first + 1 / second;
    if (!(curvature > 0)) {
      throw Refusal("CONTACT_NOT_A_POINT",
                    "Radii of curvature along " + direction + " of " + number_text(first) +
                        " m and " + number_text(second) + " m conform: there is no point contact.");
    }
    return 1 / curvature;
  };
  return {effective(radius_1x, radius_2x, "x"), effective(radius_1y, radius_2y, "y")};
}

HertzFit exact_ellipticity(double radius_x, double radius_y) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const double ratio = ratio_of_radii(radius_x, radius_y);
  if (!(radius_x > 0 && radius_y > 0 && std::isfinite(ratio))) return {kNaN, kNaN};
  if (ratio == 1) return {1, std::numbers::pi / 2};

  // ln r is a smooth function of ln k with a slope between 3/2 (circle) and 2 (line), so the
  // root lies in [1/2, 2/3] ln r. Regula falsi with the Illinois rule inside that bracket.
  const double target = std::log(ratio);
  const auto residual = [target](double log_k) {
    return laws::ellipse_shape(log_k).log_ratio - target;
  };
  // The ends are widened by a little more than rounding, and are not evaluated to be believed.
  double low = 0.5 * target * (1 - 1e-9);
  double high = 2.0 / 3.0 * target * (1 + 1e-9) + 1e-15;
  double at_low = residual(low);
  double at_high = residual(high);
  double log_k = 0.636 * target;
  int last_side = 0;
  for (int i = 0; i < 100 && at_low < 0 && at_high > 0; ++i) {
    log_k = (low * at_high - high * at_low) / (at_high - at_low);
    if (!(log_k > low && log_k < high)) break;
    const double at_middle = residual(log_k);
    if (at_middle == 0) break;
    const int side = at_middle < 0 ? -1 : 1;
    const double width = high - low;
    if (side < 0) {
      low = log_k;
      at_low = at_middle;
      if (last_side < 0) at_high /= 2;
    } else {
      high = log_k;
      at_high = at_middle;
      if (last_side > 0) at_low /= 2;
    }
    last_side = side;
    if (width <= 4 * std::numeric_limits<double>::epsilon() * high) break;
  }
  return {std::exp(log_k), laws::ellipse_shape(log_k).second_integral};
}

}  // namespace tribodyn
