// The functions that laws need of a number type, for double. pack-inl.h and dual-inl.h have the
// same for theirs. For files that are compiled once per instruction set (foreach_target.h) and for
// all others: the guard lets this one in once per set.
#if defined(TRIBODYN_CORE_NUMERICS_REAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_NUMERICS_REAL_INL_H_
#undef TRIBODYN_CORE_NUMERICS_REAL_INL_H_
#else
#define TRIBODYN_CORE_NUMERICS_REAL_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

#include "core/numerics/digits.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

template <Digits kDigits>
HWY_INLINE double exponential(double x) {
  return std::exp(x);
}
HWY_INLINE double exponential(double x) { return std::exp(x); }
HWY_INLINE double exponential_less_one(double x) { return std::expm1(x); }
template <Digits kDigits>
HWY_INLINE double logarithm(double x) {
  return std::log(x);
}
HWY_INLINE double logarithm(double x) { return std::log(x); }
HWY_INLINE double root(double x) { return std::sqrt(x); }
HWY_INLINE double square(double x) { return x * x; }
HWY_INLINE double cube_root(double x) { return std::cbrt(x); }
/// x y + z and z - x y.
HWY_INLINE double fused(double x, double y, double z) { return x * y + z; }
HWY_INLINE double less_product(double x, double y, double z) { return z - x * y; }
HWY_INLINE double least(double x, double y) { return x < y ? x : y; }
HWY_INLINE double greatest(double x, double y) { return x > y ? x : y; }
HWY_INLINE double clamped(double x, double low, double high) {
  return least(greatest(x, low), high);
}

HWY_INLINE double select(bool where, double yes, double no) { return where ? yes : no; }

/// The number without derivatives.
HWY_INLINE double value_of(double x) { return x; }

/// A function of one variable and its derivative.
template <class Real>
struct WithSlope {
  Real value, slope;
};

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_NUMERICS_REAL_INL_H_
