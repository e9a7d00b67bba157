// Dual numbers: a value with its derivatives by kCount variables. Every result that is computed
// from them has its derivatives, exact to rounding (forward automatic differentiation; A. Griewank
// and A. Walther, Evaluating Derivatives, 2nd ed., 2008, chapter 3). Compiled per instruction set
// as real-inl.h.
#if defined(TRIBODYN_CORE_NUMERICS_DUAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_NUMERICS_DUAL_INL_H_
#undef TRIBODYN_CORE_NUMERICS_DUAL_INL_H_
#else
#define TRIBODYN_CORE_NUMERICS_DUAL_INL_H_
#endif

#include <hwy/highway.h>

#include "core/numerics/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

/// Real is double or Pack. Comparisons are those of the values.
template <class Real, int kCount>
struct Dual {
  static constexpr int kVariables = kCount;
  Real value;
  Real slope[kCount];

  Dual() = default;            // not set
  HWY_INLINE Dual(double x) {  // NOLINT: a number is a dual number without derivatives
    value = x;
    for (int i = 0; i < kCount; ++i) slope[i] = 0;
  }
  /// The variable of number i.
  static HWY_INLINE Dual variable(Real x, int i) {
    Dual out(0.0);
    out.value = x;
    out.slope[i] = 1;
    return out;
  }
};

/// f(x) from its value and derivative.
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> chained(Real value, Real derivative, const Dual<Real, kCount>& x) {
  Dual<Real, kCount> out;
  out.value = value;
  for (int i = 0; i < kCount; ++i) out.slope[i] = derivative * x.slope[i];
  return out;
}
/// f(x, y) from its value and both derivatives.
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> chained(Real value, Real by_x, const Dual<Real, kCount>& x, Real by_y,
                                      const Dual<Real, kCount>& y) {
  Dual<Real, kCount> out;
  out.value = value;
  for (int i = 0; i < kCount; ++i) out.slope[i] = by_x * x.slope[i] + by_y * y.slope[i];
  return out;
}

template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator+(const Dual<Real, kCount>& x, const Dual<Real, kCount>& y) {
  Dual<Real, kCount> out;
  out.value = x.value + y.value;
  for (int i = 0; i < kCount; ++i) out.slope[i] = x.slope[i] + y.slope[i];
  return out;
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator-(const Dual<Real, kCount>& x, const Dual<Real, kCount>& y) {
  Dual<Real, kCount> out;
  out.value = x.value - y.value;
  for (int i = 0; i < kCount; ++i) out.slope[i] = x.slope[i] - y.slope[i];
  return out;
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator*(const Dual<Real, kCount>& x, const Dual<Real, kCount>& y) {
  return chained(x.value * y.value, y.value, x, x.value, y);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator/(const Dual<Real, kCount>& x, const Dual<Real, kCount>& y) {
  const Real inverse = 1.0 / y.value, quotient = x.value * inverse;
  return chained(x.value / y.value, inverse, x, -quotient * inverse, y);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator-(const Dual<Real, kCount>& x) {
  return chained(-x.value, Real(-1.0), x);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator+(Dual<Real, kCount> x, double y) {
  x.value = x.value + y;
  return x;
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator+(double x, const Dual<Real, kCount>& y) {
  return y + x;
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator-(const Dual<Real, kCount>& x, double y) {
  return x + -y;
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator-(double x, const Dual<Real, kCount>& y) {
  return chained(x - y.value, Real(-1.0), y);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator*(double x, const Dual<Real, kCount>& y) {
  return chained(x * y.value, Real(x), y);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator*(const Dual<Real, kCount>& x, double y) {
  return y * x;
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator/(const Dual<Real, kCount>& x, double y) {
  return (1 / y) * x;
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> operator/(double x, const Dual<Real, kCount>& y) {
  const Real quotient = x / y.value;
  return chained(quotient, -quotient / y.value, y);
}
template <class Real, int kCount>
HWY_INLINE auto operator<(const Dual<Real, kCount>& x, const Dual<Real, kCount>& y) {
  return x.value < y.value;
}
template <class Real, int kCount>
HWY_INLINE auto operator<(const Dual<Real, kCount>& x, double y) {
  return x.value < y;
}
template <class Real, int kCount>
HWY_INLINE auto operator>(const Dual<Real, kCount>& x, double y) {
  return x.value > y;
}
template <class Real, int kCount>
HWY_INLINE auto operator>=(const Dual<Real, kCount>& x, const Dual<Real, kCount>& y) {
  return x.value >= y.value;
}

template <Digits kDigits, class Real, int kCount>
HWY_INLINE Dual<Real, kCount> exponential(const Dual<Real, kCount>& x) {
  const Real value = exponential<kDigits>(x.value);
  return chained(value, value, x);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> exponential(const Dual<Real, kCount>& x) {
  return exponential<Digits::kFull>(x);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> exponential_less_one(const Dual<Real, kCount>& x) {
  const Real value = exponential_less_one(x.value);
  return chained(value, value + 1.0, x);
}
template <Digits kDigits, class Real, int kCount>
HWY_INLINE Dual<Real, kCount> logarithm(const Dual<Real, kCount>& x) {
  return chained(logarithm<kDigits>(x.value), 1.0 / x.value, x);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> logarithm(const Dual<Real, kCount>& x) {
  return logarithm<Digits::kFull>(x);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> root(const Dual<Real, kCount>& x) {
  const Real value = root(x.value);
  return chained(value, 0.5 / value, x);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> cube_root(const Dual<Real, kCount>& x) {
  const Real value = cube_root(x.value);
  return chained(value, value / (3.0 * x.value), x);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> square(const Dual<Real, kCount>& x) {
  return chained(x.value * x.value, 2.0 * x.value, x);
}
template <class X, class Y, class Real, int kCount>
HWY_INLINE Dual<Real, kCount> fused(const X& x, const Y& y, const Dual<Real, kCount>& z) {
  return x * y + z;
}
template <class X, class Y, class Real, int kCount>
HWY_INLINE Dual<Real, kCount> less_product(const X& x, const Y& y, const Dual<Real, kCount>& z) {
  return z - x * y;
}
/// Of x where the mask says so, of y elsewhere.
template <class Mask, class Real, int kCount>
HWY_INLINE Dual<Real, kCount> select(const Mask& where, const Dual<Real, kCount>& x,
                                     const Dual<Real, kCount>& y) {
  Dual<Real, kCount> out;
  out.value = select(where, x.value, y.value);
  for (int i = 0; i < kCount; ++i) out.slope[i] = select(where, x.slope[i], y.slope[i]);
  return out;
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> least(const Dual<Real, kCount>& x, const Dual<Real, kCount>& y) {
  return select(x.value < y.value, x, y);
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> greatest(const Dual<Real, kCount>& x, double y) {
  return select(x.value > Real(y), x, Dual<Real, kCount>(y));
}
template <class Real, int kCount>
HWY_INLINE Dual<Real, kCount> clamped(const Dual<Real, kCount>& x, double low, double high) {
  return least(greatest(x, low), Dual<Real, kCount>(high));
}

template <int kCount>
HWY_INLINE double value_of(const Dual<double, kCount>& x) {
  return x.value;
}

/// The root of a function at which an iteration has arrived, with derivatives by all variables but
/// the last, by one Newton step in dual numbers (implicit function theorem). `function` is called
/// once with the root as the last variable, which must be free for it.
template <int kCount, class Real, class Function>
Dual<Real, kCount> root_with_slopes(Real at, Function&& function) {
  using Number = Dual<Real, kCount>;
  const Number residual = function(Number::variable(at, kCount - 1));
  Number out = chained(at, -1.0 / residual.slope[kCount - 1], residual);
  out.value = at;
  out.slope[kCount - 1] = 0;
  return out;
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_NUMERICS_DUAL_INL_H_
