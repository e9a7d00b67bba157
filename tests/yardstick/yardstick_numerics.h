// Numerical tools of the yardstick: Gauss-Legendre quadrature, Brent's root finder and dense
// elimination. Written for trust rather than for speed, and shared with nothing outside this
// folder.
#pragma once

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace tribodyn::yardstick {

/// Gauss-Legendre rule on [0, 1].
struct GaussLegendreRule {
  std::vector<double> abscissae;
  std::vector<double> weights;
};

/// Nodes by Newton's method on the Legendre polynomial of degree `node_count`.
GaussLegendreRule make_gauss_legendre_rule(int node_count);

/// Integral of `function` over [lower, upper], cut into `panel_count` equal panels.
template <typename Function>
double integrate(const GaussLegendreRule& rule, const Function& function, double lower,
                 double upper, int panel_count = 1) {
  const double width = (upper - lower) / panel_count;
  double sum = 0.0;
  for (int panel = 0; panel < panel_count; ++panel) {
    const double start = lower + panel * width;
    for (std::size_t node = 0; node < rule.abscissae.size(); ++node) {
      sum += rule.weights[node] * function(start + width * rule.abscissae[node]);
    }
  }
  return sum * width;
}

/// Root of `function` in [a, b] to machine precision (Brent, Algorithms for Minimization without
/// Derivatives, 1973, ch. 4). The end values must differ in sign; an end that is a root is
/// returned. `value_a` and `value_b` are the function values there.
template <typename Function>
double find_root(const Function& function, double a, double b, double value_a, double value_b) {
  if (value_a == 0.0) return a;
  if (value_b == 0.0) return b;
  if (!((value_a < 0.0) != (value_b < 0.0))) {
    throw std::runtime_error("FindRoot: the interval does not bracket a root");
  }
  double c = a;
  double value_c = value_a;
  double step = b - a;
  double previous_step = step;
  for (int iteration = 0; iteration < 200; ++iteration) {
    if (std::abs(value_c) < std::abs(value_b)) {
      a = b;
      b = c;
      c = a;
      value_a = value_b;
      value_b = value_c;
      value_c = value_a;
    }
    const double tolerance = 2.0 * std::numeric_limits<double>::epsilon() * std::abs(b);
    const double half = 0.5 * (c - b);
    if (std::abs(half) <= tolerance || value_b == 0.0) return b;
    if (std::abs(previous_step) < tolerance || std::abs(value_a) <= std::abs(value_b)) {
      step = previous_step = half;
    } else {
      double numerator;
      double denominator;
      const double ratio = value_b / value_a;
      if (a == c) {  // secant
        numerator = 2.0 * half * ratio;
        denominator = 1.0 - ratio;
      } else {  // inverse quadratic interpolation
        const double q = value_a / value_c;
        const double r = value_b / value_c;
        numerator = ratio * (2.0 * half * q * (q - r) - (b - a) * (r - 1.0));
        denominator = (q - 1.0) * (r - 1.0) * (ratio - 1.0);
      }
      if (numerator > 0.0) denominator = -denominator;
      numerator = std::abs(numerator);
      if (2.0 * numerator < 3.0 * half * denominator - std::abs(tolerance * denominator) &&
          numerator < std::abs(0.5 * previous_step * denominator)) {
        previous_step = step;
        step = numerator / denominator;
      } else {
        step = previous_step = half;
      }
    }
    a = b;
    value_a = value_b;
    b += std::abs(step) > tolerance ? step : (half > 0.0 ? tolerance : -tolerance);
    value_b = function(b);
    if ((value_b > 0.0) == (value_c > 0.0)) {
      c = a;
      value_c = value_a;
      step = previous_step = b - a;
    }
  }
  return b;
}

template <typename Function>
double find_root(const Function& function, double a, double b) {
  return find_root(function, a, b, function(a), function(b));
}

/// Solves `matrix` x = `right_side` by elimination with row pivoting; rows of `matrix` are rows.
std::vector<double> solve_linear_system(std::vector<std::vector<double>> matrix,
                                        std::vector<double> right_side);

}  // namespace tribodyn::yardstick
