// How the stress of a block of contacts grows with pressure.
// Compiled once per instruction set by contact_block.cpp.
#if defined(TRIBODYN_CORE_CONTACT_GROWTH_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_CONTACT_GROWTH_BLOCK_INL_H_
#undef TRIBODYN_CORE_CONTACT_GROWTH_BLOCK_INL_H_
#else
#define TRIBODYN_CORE_CONTACT_GROWTH_BLOCK_INL_H_
#endif

#include <hwy/highway.h>

#include "core/contact/block_work-inl.h"
#include "core/laws/pressure_growth-inl.h"
#include "core/laws/viscosity-inl.h"
#include "core/numerics/dual-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

// Policies of the stages in shear_block-inl.h and heat_block-inl.h, one a pressure-viscosity law:
// ln tau at depth s = ln(1 + c p) and at the temperature of eval_rheology, which has left its part
// at p = 0 in law_base and law_base_slope.

/// Roelands: ln tau = law_base + L (e^(Z s) - 1), in closed form throughout.
struct RoelandsGrowth {
  /// Leaves what stays while the temperature is sought.
  template <Digits kDigits>
  static HWY_INLINE void prepare_end(const Tables& t, Pack end, Work& work, int i) {
    store(exponential<kDigits>(t.shear.index * end) - 1, work.end_growth + i);
  }
  static HWY_INLINE Pack log_stress_at_end(const Tables&, const Work& work, int i) {
    return log_under_pressure(load(work.law_base + i), load(work.factor + i),
                              load(work.end_growth + i));
  }
  /// Leaves what the slopes below consist of.
  template <Digits kDigits>
  static HWY_INLINE Pack log_stress_at_cut(const Tables& t, Pack cut, Work& work, int i) {
    const Pack e_growth = exponential<kDigits>(t.shear.index * cut);
    store(e_growth, work.e_growth + i);
    return log_under_pressure(load(work.law_base + i), load(work.factor + i), e_growth - 1);
  }
  /// d ln tau/dT and d ln tau/ds at the cut.
  static HWY_INLINE Pack slope_by_temperature(const Work& work, int i) {
    return fused(load(work.factor_slope + i), load(work.e_growth + i) - 1,
                 load(work.law_base_slope + i));
  }
  static HWY_INLINE Pack slope_by_depth(const Tables& t, const Work& work, int i) {
    return load(work.factor + i) * t.shear.index * load(work.e_growth + i);
  }
  /// The depth at which ln tau reaches a value, nearly.
  static HWY_INLINE Pack depth_of(const Tables& t, Pack log_stress, const Work& work, int i) {
    const Pack per_factor = 1 / load(work.factor + i);
    const Pack folds = greatest((log_stress - load(work.law_base + i)) * per_factor, 1e-3);
    return logarithm<Digits::kHalf>(folds + 1) * (1 / t.shear.index);
  }
};

/// Any other law, its slopes by dual numbers.
struct LawGrowth {
  using Number = Dual<Pack, 2>;  // by temperature and by depth

  static HWY_INLINE Number growth(const Tables& t, Pack depth, const Work& work, int i) {
    const Number temperature = Number::variable(load(work.base + i) + load(work.rise + i), 0);
    const Number pressure =
        exponential_less_one(Number::variable(depth, 1)) * (1 / kRoelandsPressureCoefficient);
    return pressure_growth(t.shear.growth, temperature, pressure);
  }
  template <Digits kDigits>
  static HWY_INLINE void prepare_end(const Tables&, Pack, Work&, int) {}
  static HWY_INLINE Pack log_stress_at_end(const Tables& t, const Work& work, int i) {
    return load(work.law_base + i) + growth(t, load(work.end + i), work, i).value;
  }
  template <Digits kDigits>
  static HWY_INLINE Pack log_stress_at_cut(const Tables& t, Pack cut, Work& work, int i) {
    const Number at = growth(t, cut, work, i);
    store(at.slope[0], work.growth_by_temperature + i);
    store(at.slope[1], work.growth_by_depth + i);
    return load(work.law_base + i) + at.value;
  }
  static HWY_INLINE Pack slope_by_temperature(const Work& work, int i) {
    return load(work.law_base_slope + i) + load(work.growth_by_temperature + i);
  }
  static HWY_INLINE Pack slope_by_depth(const Tables&, const Work& work, int i) {
    return load(work.growth_by_depth + i);
  }
  /// By the chord to the end of the table and two steps of Newton's method.
  static HWY_INLINE Pack depth_of(const Tables& t, Pack log_stress, const Work& work, int i) {
    const Pack end = load(work.end + i), rise = log_stress - load(work.law_base + i);
    Pack depth = end * clamped(rise / growth(t, end, work, i).value, 0.02, 1);
    for (int n = 0; n < 2; ++n) {
      const Number at = growth(t, depth, work, i);
      depth = clamped(depth + (rise - at.value) / at.slope[1], 0.25 * depth, end);
    }
    return depth;
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_CONTACT_GROWTH_BLOCK_INL_H_
