#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace tribodyn {

/// A root of f inside [lower, upper], where f changes sign, to the last bits of x.
/// Bisection with inverse quadratic steps after Chandrupatla (1997, Adv. Eng. Software 28, 145):
/// never leaves the bracket, never takes more than about three times bisection's steps.
/// f(lower) and f(upper) are passed so that nothing is evaluated twice.
template <class Function>
double bracketed_root(Function&& f, double lower, double upper, double f_lower, double f_upper) {
  if (f_lower == 0) return lower;
  if (f_upper == 0) return upper;
  double a = upper, b = lower, c = upper, fa = f_upper, fb = f_lower, fc = f_upper, t = 0.5;
  for (int i = 0; i < 200; ++i) {
    const double x = a + t * (b - a);
    const double fx = f(x);
    if (std::signbit(fx) == std::signbit(fa)) {
      c = a;
      fc = fa;
    } else {
      c = b;
      b = a;
      fc = fb;
      fb = fa;
    }
    a = x;
    fa = fx;
    const double best = std::abs(fa) < std::abs(fb) ? a : b;
    const double tolerance = std::numeric_limits<double>::epsilon() * std::abs(best) +
                             std::numeric_limits<double>::min();
    const double relative = tolerance / std::abs(b - c);
    if (relative > 0.5 || fa == 0) return fa == 0 ? a : best;
    const double xi = (a - b) / (c - b), phi = (fa - fb) / (fc - fb);
    if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi) {
      t = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb);
    } else {
      t = 0.5;
    }
    t = std::clamp(t, relative, 1 - relative);
  }
  return std::abs(fa) < std::abs(fb) ? a : b;
}

template <class Function>
double bracketed_root(Function&& f, double lower, double upper) {
  return bracketed_root(f, lower, upper, f(lower), f(upper));
}

struct ValueAndSlope {
  double value, slope;
};

/// A root of f inside [lower, upper] by Newton steps that never leave the bracket and fall back to
/// bisection when they do not halve it fast enough (so that no two-cycle survives). f returns
/// {value, slope}; f(lower) < 0 < f(upper) when `rising`, the reverse otherwise (not evaluated
/// here). Stops when the value is zero or a step is below `tolerance` of max(|x|, 1): Newton's
/// error after such a step is of the order of its square, so 1e-8 is enough for the last bit of a
/// smooth f.
template <class Function>
double safeguarded_newton(Function&& f, double lower, double upper, double start, bool rising,
                          double tolerance = 1e-15) {
  double x = std::clamp(start, lower, upper);
  double before_last = upper - lower, last = before_last;
  for (int i = 0; i < 200; ++i) {
    const ValueAndSlope at = f(x);
    if (at.value == 0) return x;
    ((at.value > 0) == rising ? upper : lower) = x;
    double next = x - at.value / at.slope;
    if (next == x) return x;
    if (!(next > lower && next < upper) || std::abs(next - x) > 0.5 * std::abs(before_last)) {
      next = 0.5 * (lower + upper);
    }
    before_last = last;
    last = next - x;
    x = next;
    if (std::abs(last) <= tolerance * std::max(std::abs(x), 1.0)) return x;
  }
  return x;
}

}  // namespace tribodyn
