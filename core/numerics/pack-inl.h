// Vectors side by side, for files that are compiled once per instruction set (foreach_target.h):
// the guard lets this one in once per set.
#if defined(TRIBODYN_CORE_NUMERICS_PACK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_NUMERICS_PACK_INL_H_
#undef TRIBODYN_CORE_NUMERICS_PACK_INL_H_
#else
#define TRIBODYN_CORE_NUMERICS_PACK_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <numbers>

#include "core/numerics/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<double>;
using Vector = hn::Vec<Tag>;
using BitTag = hn::RebindToUnsigned<Tag>;
constexpr Tag kTag;
constexpr BitTag kBits;

/// Vectors side by side: their chains of dependent instructions overlap.
constexpr int kWide = 2;
struct Pack {
  Vector v[kWide];

  Pack() = default;                // not set; trivial, so that no function is made for it
  HWY_INLINE Pack(double value) {  // NOLINT: a number is a pack
    for (int k = 0; k < kWide; ++k) v[k] = hn::Set(kTag, value);
  }
};
struct Mask {
  hn::Mask<Tag> m[kWide];
};
HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(kTag)); }
HWY_INLINE int pack_lanes() { return kWide * lanes(); }

HWY_INLINE Pack load(const double* from) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::Load(kTag, from + k * lanes());
  return out;
}
HWY_INLINE Pack load_any(const double* from) {  // of any alignment
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::LoadU(kTag, from + k * lanes());
  return out;
}
HWY_INLINE void store(Pack x, double* to) {
  for (int k = 0; k < kWide; ++k) hn::Store(x.v[k], kTag, to + k * lanes());
}
HWY_INLINE void store_any(Pack x, double* to) {
  for (int k = 0; k < kWide; ++k) hn::StoreU(x.v[k], kTag, to + k * lanes());
}
HWY_INLINE Pack operator+(Pack x, Pack y) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::Add(x.v[k], y.v[k]);
  return out;
}
HWY_INLINE Pack operator-(Pack x, Pack y) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::Sub(x.v[k], y.v[k]);
  return out;
}
HWY_INLINE Pack operator*(Pack x, Pack y) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::Mul(x.v[k], y.v[k]);
  return out;
}
HWY_INLINE Pack operator/(Pack x, Pack y) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::Div(x.v[k], y.v[k]);
  return out;
}
HWY_INLINE Pack operator-(Pack x) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::Neg(x.v[k]);
  return out;
}
/// x y + z and z - x y, rounded once where the instructions allow.
HWY_INLINE Pack fused(Pack x, Pack y, Pack z) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::MulAdd(x.v[k], y.v[k], z.v[k]);
  return out;
}
HWY_INLINE Pack less_product(Pack x, Pack y, Pack z) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::NegMulAdd(x.v[k], y.v[k], z.v[k]);
  return out;
}
HWY_INLINE Pack least(Pack x, Pack y) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::Min(x.v[k], y.v[k]);
  return out;
}
HWY_INLINE Pack greatest(Pack x, Pack y) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::Max(x.v[k], y.v[k]);
  return out;
}
HWY_INLINE Pack clamped(Pack x, Pack low, Pack high) { return least(greatest(x, low), high); }
HWY_INLINE Pack root(Pack x) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::Sqrt(x.v[k]);
  return out;
}
HWY_INLINE Pack size(Pack x) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::Abs(x.v[k]);
  return out;
}
HWY_INLINE Pack square(Pack x) { return x * x; }
HWY_INLINE Mask operator<(Pack x, Pack y) {
  Mask out;
  for (int k = 0; k < kWide; ++k) out.m[k] = hn::Lt(x.v[k], y.v[k]);
  return out;
}
HWY_INLINE Mask operator<=(Pack x, Pack y) {
  Mask out;
  for (int k = 0; k < kWide; ++k) out.m[k] = hn::Le(x.v[k], y.v[k]);
  return out;
}
HWY_INLINE Mask operator>(Pack x, Pack y) { return y < x; }
HWY_INLINE Mask operator>=(Pack x, Pack y) { return y <= x; }
HWY_INLINE Mask operator&(Mask x, Mask y) {
  Mask out;
  for (int k = 0; k < kWide; ++k) out.m[k] = hn::And(x.m[k], y.m[k]);
  return out;
}
HWY_INLINE Mask operator|(Mask x, Mask y) {
  Mask out;
  for (int k = 0; k < kWide; ++k) out.m[k] = hn::Or(x.m[k], y.m[k]);
  return out;
}
HWY_INLINE Mask operator~(Mask x) {
  Mask out;
  for (int k = 0; k < kWide; ++k) out.m[k] = hn::Not(x.m[k]);
  return out;
}
HWY_INLINE Mask nowhere() { return Pack(1) < Pack(0); }
HWY_INLINE bool any(Mask x) {
  hn::Mask<Tag> some = x.m[0];
  for (int k = 1; k < kWide; ++k) some = hn::Or(some, x.m[k]);
  return !hn::AllFalse(kTag, some);
}
HWY_INLINE Pack select(Mask where, Pack yes, Pack no) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::IfThenElse(where.m[k], yes.v[k], no.v[k]);
  return out;
}
HWY_INLINE Pack where(Mask mask, Pack x) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = hn::IfThenElseZero(mask.m[k], x.v[k]);
  return out;
}
HWY_INLINE Pack as_number(Mask mask) { return where(mask, 1); }
HWY_INLINE Mask within(Pack x, double low, double high) { return (x >= low) & (x <= high); }

/// x = n ln 2 + r, |r| <= ln 2/2: n in the lowest bits of `shifted`, and e^r - 1 by Taylor's
/// series.
struct ReducedExponential {
  Vector shifted, less_one;
};

template <Digits kDigits>
HWY_INLINE ReducedExponential reduced_exponential(Vector x) {
  const auto c = [](double value) { return hn::Set(kTag, value); };
  constexpr double kRound = 0x1.8p52;  // its sum with n has n in its lowest bits
  constexpr double kLogTwo = 0x1.62e42fefa38p-1, kLogTwoRest = 0x1.ef35793c7673p-45;
  const Vector shifted = hn::MulAdd(x, c(std::numbers::log2e), c(kRound));
  const Vector n = hn::Sub(shifted, c(kRound));
  Vector r = hn::NegMulAdd(n, c(kLogTwo), x);
  if (kDigits == Digits::kFull) {
    r = hn::NegMulAdd(n, c(kLogTwoRest), r);
    const Vector r2 = hn::Mul(r, r);
    Vector even = c(1.0 / 479001600), odd = c(1.0 / 39916800);
    even = hn::MulAdd(even, r2, c(1.0 / 3628800));
    odd = hn::MulAdd(odd, r2, c(1.0 / 362880));
    even = hn::MulAdd(even, r2, c(1.0 / 40320));
    odd = hn::MulAdd(odd, r2, c(1.0 / 5040));
    even = hn::MulAdd(even, r2, c(1.0 / 720));
    odd = hn::MulAdd(odd, r2, c(1.0 / 120));
    even = hn::MulAdd(even, r2, c(1.0 / 24));
    odd = hn::MulAdd(odd, r2, c(1.0 / 6));
    even = hn::MulAdd(even, r2, c(0.5));
    return {shifted, hn::MulAdd(hn::MulAdd(odd, r, even), r2, r)};
  }
  const Vector r2 = hn::Mul(r, r);
  const Vector odd = hn::MulAdd(c(1.0 / 5040), r2, c(1.0 / 120));
  const Vector even = hn::MulAdd(c(1.0 / 720), r2, c(1.0 / 24));
  const Vector high = hn::MulAdd(odd, r, even), low = hn::MulAdd(c(1.0 / 6), r, c(0.5));
  return {shifted, hn::MulAdd(hn::MulAdd(high, r2, low), r2, r)};
}

/// e^x for |x| <= 700, anything beyond. Leaner than the library's, which also serves results that
/// are subnormal or infinite. (One vector after the other: interleaved, they would run out of
/// registers.)
template <Digits kDigits>
HWY_INLINE Vector exponential(Vector x) {
  const ReducedExponential e = reduced_exponential<kDigits>(x);
  const Vector power = hn::Add(e.less_one, hn::Set(kTag, 1));
  return hn::BitCast(
      kTag, hn::Add(hn::BitCast(kBits, power), hn::ShiftLeft<52>(hn::BitCast(kBits, e.shifted))));
}

/// e^x - 1 for |x| <= 700, with all digits of small ones.
HWY_INLINE Vector exponential_less_one(Vector x) {
  const ReducedExponential e = reduced_exponential<Digits::kFull>(x);
  const Vector one = hn::Set(kTag, 1);
  const Vector scale = hn::BitCast(
      kTag, hn::Add(hn::BitCast(kBits, one), hn::ShiftLeft<52>(hn::BitCast(kBits, e.shifted))));
  return hn::MulAdd(scale, e.less_one, hn::Sub(scale, one));
}

/// ln x for normal x > 0: x = 2^n m, sqrt(1/2) <= m < sqrt(2), ln m = 2 artanh((m - 1)/(m + 1)).
template <Digits kDigits>
HWY_INLINE Vector logarithm(Vector x) {
  const auto c = [](double value) { return hn::Set(kTag, value); };
  const auto bits_of = [](std::uint64_t value) { return hn::Set(kBits, value); };
  constexpr std::uint64_t kRootHalf = 0x3FE6A09E00000000, kOne = 0x3FF0000000000000;
  const auto bits = hn::Add(hn::BitCast(kBits, x), bits_of(kOne - kRootHalf));
  // 2^52 + n + 1023 has n + 1023 in its lowest bits.
  const Vector n =
      hn::Sub(hn::BitCast(kTag, hn::Or(hn::ShiftRight<52>(bits), bits_of(0x4330000000000000))),
              c(0x1p52 + 1023));
  const Vector m =
      hn::BitCast(kTag, hn::Add(hn::And(bits, bits_of(0x000FFFFFFFFFFFFF)), bits_of(kRootHalf)));
  const Vector z = hn::Div(hn::Sub(m, c(1)), hn::Add(m, c(1)));
  const Vector z2 = hn::Mul(z, z);
  Vector p;
  if (kDigits == Digits::kFull) {
    const Vector z4 = hn::Mul(z2, z2);
    Vector even = hn::MulAdd(c(2.0 / 19), z4, c(2.0 / 15));
    Vector odd = hn::MulAdd(c(2.0 / 21), z4, c(2.0 / 17));
    even = hn::MulAdd(even, z4, c(2.0 / 11));
    odd = hn::MulAdd(odd, z4, c(2.0 / 13));
    even = hn::MulAdd(even, z4, c(2.0 / 7));
    odd = hn::MulAdd(odd, z4, c(2.0 / 9));
    even = hn::MulAdd(even, z4, c(2.0 / 3));
    odd = hn::MulAdd(odd, z4, c(2.0 / 5));
    p = hn::MulAdd(odd, z2, even);
  } else {
    p = hn::MulAdd(hn::MulAdd(c(2.0 / 7), z2, c(2.0 / 5)), z2, c(2.0 / 3));
  }
  const Vector log_m = hn::MulAdd(hn::Mul(z, z2), p, hn::Add(z, z));
  return hn::MulAdd(n, c(std::numbers::ln2), log_m);
}

template <Digits kDigits>
HWY_INLINE Pack exponential(Pack x) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = exponential<kDigits>(x.v[k]);
  return out;
}
HWY_INLINE Pack exponential_less_one(Pack x) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = exponential_less_one(x.v[k]);
  return out;
}
template <Digits kDigits>
HWY_INLINE Pack logarithm(Pack x) {
  Pack out;
  for (int k = 0; k < kWide; ++k) out.v[k] = logarithm<kDigits>(x.v[k]);
  return out;
}
HWY_INLINE Pack exponential(Pack x) { return exponential<Digits::kFull>(x); }
HWY_INLINE Pack logarithm(Pack x) { return logarithm<Digits::kFull>(x); }

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif
