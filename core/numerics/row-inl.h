// A few numbers as one value, for files that are compiled once per instruction set
// (foreach_target.h): the guard lets this one in once per set.
#if defined(TRIBODYN_CORE_NUMERICS_ROW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_NUMERICS_ROW_INL_H_
#undef TRIBODYN_CORE_NUMERICS_ROW_INL_H_
#else
#define TRIBODYN_CORE_NUMERICS_ROW_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// As many numbers as a matrix of 4 x 4 or 8 x 8 has in a row or column.
template <int kSize>
struct Row {
  static_assert(kSize == 4 || kSize == 8);
  using Tag = hn::CappedTag<double, kSize>;
  static constexpr int kParts = kSize / (HWY_MAX_BYTES / 8 < kSize ? HWY_MAX_BYTES / 8 : kSize);
  static HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(Tag())); }
  hn::Vec<Tag> v[kParts];

  Row() = default;                // not set
  HWY_INLINE Row(double value) {  // NOLINT: a number is a row
    for (int k = 0; k < kParts; ++k) v[k] = hn::Set(Tag(), value);
  }
};
template <int kSize>
HWY_INLINE Row<kSize> load_row(const double* from) {
  Row<kSize> out;
  for (int k = 0; k < out.kParts; ++k) {
    out.v[k] = hn::LoadU(typename Row<kSize>::Tag(), from + k * out.lanes());
  }
  return out;
}
template <int kSize>
HWY_INLINE void store_row(const Row<kSize>& x, double* to) {
  for (int k = 0; k < x.kParts; ++k) {
    hn::StoreU(x.v[k], typename Row<kSize>::Tag(), to + k * x.lanes());
  }
}
template <int kSize>
HWY_INLINE Row<kSize> operator+(const Row<kSize>& x, const Row<kSize>& y) {
  Row<kSize> out;
  for (int k = 0; k < out.kParts; ++k) out.v[k] = hn::Add(x.v[k], y.v[k]);
  return out;
}
template <int kSize>
HWY_INLINE Row<kSize> operator-(const Row<kSize>& x, const Row<kSize>& y) {
  Row<kSize> out;
  for (int k = 0; k < out.kParts; ++k) out.v[k] = hn::Sub(x.v[k], y.v[k]);
  return out;
}
template <int kSize>
HWY_INLINE Row<kSize> operator-(const Row<kSize>& x) {
  Row<kSize> out;
  for (int k = 0; k < out.kParts; ++k) out.v[k] = hn::Neg(x.v[k]);
  return out;
}
/// a x with a number a.
template <int kSize>
HWY_INLINE Row<kSize> operator*(double a, const Row<kSize>& x) {
  Row<kSize> out;
  const auto factor = hn::Set(typename Row<kSize>::Tag(), a);
  for (int k = 0; k < out.kParts; ++k) out.v[k] = hn::Mul(factor, x.v[k]);
  return out;
}
/// a x + y and y - a x with a number a, rounded once where the instructions allow.
template <int kSize>
HWY_INLINE Row<kSize> fused(double a, const Row<kSize>& x, const Row<kSize>& y) {
  Row<kSize> out;
  const auto factor = hn::Set(typename Row<kSize>::Tag(), a);
  for (int k = 0; k < out.kParts; ++k) out.v[k] = hn::MulAdd(factor, x.v[k], y.v[k]);
  return out;
}
template <int kSize>
HWY_INLINE Row<kSize> less_product(double a, const Row<kSize>& x, const Row<kSize>& y) {
  Row<kSize> out;
  const auto factor = hn::Set(typename Row<kSize>::Tag(), a);
  for (int k = 0; k < out.kParts; ++k) out.v[k] = hn::NegMulAdd(factor, x.v[k], y.v[k]);
  return out;
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_NUMERICS_ROW_INL_H_
