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

// Carlson's symmetric integral R_D(x, y, z) by duplication (DLMF 19.26.23, 19.36.2): the arguments
// draw together by a factor of four per step, then a series of fifth order ends it.
// x, y >= 0, at most one of them 0, z > 0.
double carlson_rd(double x, double y, double z) {
  constexpr double kCloseness = 6e-4;  // error of the series 3 kCloseness^6: below 1e-18
  double sum = 0;
  double scale = 1;
  double mean;
  double dx, dy, dz;
  for (;;) {
    mean = (x + y + 3 * z) / 5;
    dx = (mean - x) / mean;
    dy = (mean - y) / mean;
    dz = (mean - z) / mean;
    if (std::max({std::abs(dx), std::abs(dy), std::abs(dz)}) < kCloseness) break;
    const double root_x = std::sqrt(x);
    const double root_y = std::sqrt(y);
    const double root_z = std::sqrt(z);
    const double shift = root_x * root_y + root_y * root_z + root_z * root_x;
    sum += scale / (root_z * (z + shift));
    scale /= 4;
    x = (x + shift) / 4;
    y = (y + shift) / 4;
    z = (z + shift) / 4;
  }
  const double xy = dx * dy;
  const double zz = dz * dz;
  const double e2 = xy - 6 * zz;
  const double e3 = (3 * xy - 8 * zz) * dz;
  const double e4 = 3 * (xy - zz) * zz;
  const double e5 = xy * zz * dz;
  const double series =
      1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 - 9 * e2 * e3 / 52 + 3 * e5 / 26;
  return 3 * sum + scale * series / (mean * std::sqrt(mean));
}

// With q = 1/k^2 = 1 - m: K - E = (m/3) R_D(0, q, 1) and E - q K = (m q/3) R_D(0, 1, q)
// (DLMF 19.25.1). So Hertz's relation and E have no cancellation left in them:
//   r = R_D(0, 1, q)/R_D(0, q, 1),   E = (q/3) (R_D(0, 1, q) + R_D(0, q, 1)).
// Beyond k = e^40 they are 2 ln k - ln(ln 4k - 1) and 1 to the last bit, and q would underflow.
struct EllipseShape {
  double log_ratio;        // ln r
  double second_integral;  // E
};

EllipseShape ellipse_shape(double log_k) {
  if (log_k > 40) return {2 * log_k - std::log(std::log(4.0) + log_k - 1), 1};
  const double q = std::exp(-2 * log_k);
  const double along = carlson_rd(0, 1, q);
  const double across = carlson_rd(0, q, 1);
  return {std::log(along / across), q / 3 * (along + across)};
}

}  // namespace

double reduced_modulus(double youngs_modulus, double poissons_ratio) {
  return youngs_modulus / (1 - poissons_ratio * poissons_ratio);
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

HertzFit simplified_ellipticity(double radius_x, double radius_y, const AsPublished& as_published) {
  const double ratio = ratio_of_radii(radius_x, radius_y);
  const double printed_or_correct = as_published.eq22_inverted_ratio ? ratio : 1 / ratio;
  return {1.0339 * std::pow(ratio, 0.636), 1.0003 + 0.5968 * printed_or_correct};
}

HertzFit exact_ellipticity(double radius_x, double radius_y) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const double ratio = ratio_of_radii(radius_x, radius_y);
  if (!(radius_x > 0 && radius_y > 0 && std::isfinite(ratio))) return {kNaN, kNaN};
  if (ratio == 1) return {1, std::numbers::pi / 2};

  // ln r is a smooth function of ln k with a slope between 3/2 (circle) and 2 (line), so the
  // root lies in [1/2, 2/3] ln r. Regula falsi with the Illinois rule inside that bracket.
  const double target = std::log(ratio);
  const auto residual = [target](double log_k) { return ellipse_shape(log_k).log_ratio - target; };
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
  return {std::exp(log_k), ellipse_shape(log_k).second_integral};
}

UnitLoadEllipse unit_load_ellipse(const HertzFit& fit, double radius_x, double radius_y,
                                  double reduced_modulus, const AsPublished& as_published) {
  const double k = fit.ellipticity;
  const double eps = fit.second_integral;
  const double radius = radius_x * radius_y / (radius_x + radius_y);
  const double common = 6 * radius / (std::numbers::pi * reduced_modulus);
  UnitLoadEllipse unit_load;
  unit_load.semi_major =
      std::cbrt(common * k * k * (as_published.eq20_semi_major ? eps * eps : eps));
  unit_load.semi_minor = std::cbrt(common * eps / k);
  unit_load.maximum_pressure =
      1.5 / (std::numbers::pi * unit_load.semi_major * unit_load.semi_minor);
  return unit_load;
}

EllipseAxes ellipse_axes(const UnitLoadEllipse& unit_load, double load) {
  const double root = std::cbrt(load);
  return {unit_load.semi_major * root, unit_load.semi_minor * root,
          unit_load.maximum_pressure * root};
}

}  // namespace tribodyn
