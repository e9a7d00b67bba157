// The shear stress of the films of a block of contacts.
// Compiled once per instruction set by contact_block.cpp.
#if defined(TRIBODYN_CORE_CONTACT_SHEAR_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_CONTACT_SHEAR_BLOCK_INL_H_
#undef TRIBODYN_CORE_CONTACT_SHEAR_BLOCK_INL_H_
#else
#define TRIBODYN_CORE_CONTACT_SHEAR_BLOCK_INL_H_
#endif

#include <hwy/highway.h>

#include "core/contact/growth_block-inl.h"
#include "core/laws/film-inl.h"
#include "core/laws/shear-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

/// The shear rate, and logarithms and powers that stay while the temperature is sought.
template <class Growth, Digits kDigits>
HWY_INLINE void prepare_shear(const Tables& t, Pack slide, Pack film, Pack pressure,
                              double* shear_rate, Work& work, int i) {
  const double rim_limit = t.shear.lubricant.limiting_shear_stress_at_zero_pressure;
  const Pack scaled = kRoelandsPressureCoefficient * pressure;
  const Pack inverse = 1 / (scaled * film);
  const Pack rate = slide * scaled * inverse;
  store(rate, shear_rate + i);
  store(film * inverse, work.per_scaled + i);
  const Pack end_pressure = least(scaled, t.deepest_pressure);
  const Pack end = logarithm<kDigits>(end_pressure + 1);
  store(logarithm<kDigits>(rate), work.log_shear_rate + i);
  store(scaled, work.scaled_pressure + i);
  store(end, work.end + i);
  Growth::template prepare_end<kDigits>(t, end, work, i);
  if (t.limited) {
    store(logarithm<kDigits>(limiting_shear_stress(rim_limit, t.limit_slope, end_pressure)),
          work.end_log_limit + i);
    store(mean_limiting_shear_stress(rim_limit, t.limit_slope, scaled), work.all_limit + i);
  }
}

/// ln tau at p = 0 and L, at T = base + rise, with slopes in temperature.
template <Digits kDigits>
HWY_INLINE void eval_rheology(const Tables& t, Work& work, int i) {
  const LogStress<Pack> law = log_stress<kDigits>(
      t.shear, load(work.base + i) + load(work.rise + i), load(work.log_shear_rate + i));
  store(law.factor, work.factor + i);
  store(law.factor_slope, work.factor_slope + i);
  store(law.base, work.law_base + i);
  store(law.base_slope, work.law_base_slope + i);
}

template <class Growth>
HWY_INLINE Pack excess_at_end(const Tables& t, const Work& work, int i) {
  return Growth::log_stress_at_end(t, work, i) - load(work.end_log_limit + i);
}

/// The stress where it is cut off, at the place where it met tau_L or at the centre.
template <class Growth, Digits kDigits>
HWY_INLINE void eval_stress(const Tables& t, Work& work, int i) {
  Pack cut = load(work.end + i);
  if (t.limited) {
    const Mask clipped = excess_at_end<Growth>(t, work, i) > 0;
    cut = select(clipped, load(work.cut + i), cut);
    store(cut, work.cut + i);
    store(as_number(clipped), work.clipped + i);
  }
  const Pack log_value = Growth::template log_stress_at_cut<kDigits>(t, cut, work, i);
  store(exponential<kDigits>(cut), work.e_cut + i);
  store(exponential<kDigits>(clamped(log_value, -600, 100)), work.stress + i);
}

/// R and its slope in L.
template <Digits kDigits>
HWY_INLINE void eval_ratio(const Tables& t, Work& work, int i) {
  const BivariatePolynomial& r = kDigits == Digits::kFull ? t.ratio : t.coarse_ratio;
  const Pack x = clamped(fused(t.factor_scale, load(work.factor + i), t.factor_offset), -1, 1);
  const Pack y = clamped(fused(t.depth_scale, load(work.cut + i), t.depth_offset), -1, 1);
  const double* c = r.coefficients.data();
  Pack value = 0, slope = 0;
  for (const int length : r.row_length) {
    const double* const end = c + length;
    Pack row = *c++;
    while (c != end) row = fused(row, y, *c++);
    slope = fused(slope, x, value);
    value = fused(value, x, row);
  }
  store(value, work.ratio + i);
  store(slope * t.factor_scale, work.ratio_slope + i);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_CONTACT_SHEAR_BLOCK_INL_H_
