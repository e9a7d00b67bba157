// The shear stress of the films of a block of contacts.
// Compiled once per instruction set by contact_block.cpp.
#if defined(TRIBODYN_CORE_CONTACT_SHEAR_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_CONTACT_SHEAR_BLOCK_INL_H_
#undef TRIBODYN_CORE_CONTACT_SHEAR_BLOCK_INL_H_
#else
#define TRIBODYN_CORE_CONTACT_SHEAR_BLOCK_INL_H_
#endif

#include <hwy/highway.h>

#include <concepts>

#include "core/contact/block_work-inl.h"
#include "core/laws/film-inl.h"
#include "core/laws/pressure_growth-inl.h"
#include "core/laws/shear-inl.h"
#include "core/numerics/dual-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

/// ln tau at a depth, and its slopes there.
struct StressAtDepth {
  Pack log_value, by_temperature, by_depth;
};

/// How ln tau grows with pressure under a pressure-viscosity law: a policy of the stages here, in
/// heat_block-inl.h and in contact_block.cpp. Depth s = ln(1 + c p); the temperature is that of
/// eval_rheology(), which leaves the part at p = 0 in law_base and law_base_slope.
template <class G>
concept PressureGrowth = requires(const Tables& t, Work& work, const Work& prepared, Pack depth,
                                  Pack log_stress, int i) {
  // Leaves what stays while the temperature is sought.
  G::template prepare_end<Digits::kFull>(t, depth, work, i);
  { G::log_stress_at_end(t, prepared, i) } -> std::same_as<Pack>;
  { G::template at<Digits::kFull>(t, depth, prepared, i) } -> std::same_as<StressAtDepth>;
  // The depth at which ln tau reaches a value, nearly, as a function of that value.
  { G::depth_function(t, prepared, i).of(log_stress) } -> std::same_as<Pack>;
};

/// Roelands: ln tau = law_base + L (e^(Z s) - 1), in closed form throughout.
struct RoelandsGrowth {
  template <Digits kDigits>
  static HWY_INLINE void prepare_end(const Tables& t, Pack end, Work& work, int i) {
    store(exponential<kDigits>(t.shear.index * end) - 1, work.end_growth + i);
  }
  static HWY_INLINE Pack log_stress_at_end(const Tables&, const Work& work, int i) {
    return log_under_pressure(load(work.law_base + i), load(work.factor + i),
                              load(work.end_growth + i));
  }
  template <Digits kDigits>
  static HWY_INLINE StressAtDepth at(const Tables& t, Pack depth, const Work& work, int i) {
    const Pack factor = load(work.factor + i);
    const Pack e_growth = exponential<kDigits>(t.shear.index * depth);
    return {log_under_pressure(load(work.law_base + i), factor, e_growth - 1),
            fused(load(work.factor_slope + i), e_growth - 1, load(work.law_base_slope + i)),
            factor * t.shear.index * e_growth};
  }
  struct DepthFunction {
    double per_index;
    Pack base, per_factor;
    HWY_INLINE Pack of(Pack log_stress) const {
      const Pack growth = greatest((log_stress - base) * per_factor, 1e-3);
      return logarithm<Digits::kHalf>(growth + 1) * per_index;
    }
  };
  static HWY_INLINE DepthFunction depth_function(const Tables& t, const Work& work, int i) {
    return {1 / t.shear.index, load(work.law_base + i), 1 / load(work.factor + i)};
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
  static HWY_INLINE StressAtDepth at(const Tables& t, Pack depth, const Work& work, int i) {
    const Number growth_there = growth(t, depth, work, i);
    return {load(work.law_base + i) + growth_there.value,
            load(work.law_base_slope + i) + growth_there.slope[0], growth_there.slope[1]};
  }
  /// By the chord to the end of the table and two steps of Newton's method.
  struct DepthFunction {
    const Tables& t;
    const Work& work;
    int i;
    Pack end, per_growth_at_end;
    HWY_INLINE Pack of(Pack log_stress) const {
      const Pack rise = log_stress - load(work.law_base + i);
      Pack depth = end * clamped(rise * per_growth_at_end, 0.02, 1);
      for (int n = 0; n < 2; ++n) {
        const Number at = growth(t, depth, work, i);
        depth = clamped(depth + (rise - at.value) / at.slope[1], 0.25 * depth, end);
      }
      return depth;
    }
  };
  static HWY_INLINE DepthFunction depth_function(const Tables& t, const Work& work, int i) {
    const Pack end = load(work.end + i);
    return {t, work, i, end, 1 / growth(t, end, work, i).value};
  }
};

/// The shear rate, and logarithms and powers that stay while the temperature is sought.
template <PressureGrowth Growth, Digits kDigits>
HWY_INLINE void prepare_shear(const Tables& t, Pack slide, Pack film, Pack pressure,
                              double* shear_rate, Work& work, int i) {
  const double edge_limit = t.shear.lubricant.limiting_shear_stress_at_zero_pressure;
  const Pack scaled = kRoelandsPressureCoefficient * pressure;
  const Pack inverse = 1 / (scaled * film);
  const Pack rate = slide * scaled * inverse;
  store(rate, shear_rate + i);
  store(film * inverse, work.per_scaled + i);
  const Pack end_pressure = least(scaled, t.maximum_scaled_pressure);
  const Pack end = logarithm<kDigits>(end_pressure + 1);
  store(logarithm<kDigits>(rate), work.log_shear_rate + i);
  store(scaled, work.scaled_pressure + i);
  store(end, work.end + i);
  Growth::template prepare_end<kDigits>(t, end, work, i);
  if (t.limited) {
    store(logarithm<kDigits>(limiting_shear_stress(edge_limit, t.limit_slope, end_pressure)),
          work.end_log_limit + i);
    store(mean_limiting_shear_stress(edge_limit, t.limit_slope, scaled), work.all_limit + i);
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

template <PressureGrowth Growth>
HWY_INLINE Pack excess_at_end(const Tables& t, const Work& work, int i) {
  return Growth::log_stress_at_end(t, work, i) - load(work.end_log_limit + i);
}

/// The stress where it is cut off, at the place where it met tau_L or at the centre.
template <PressureGrowth Growth, Digits kDigits>
HWY_INLINE void eval_stress(const Tables& t, Work& work, int i) {
  Pack cut = load(work.end + i);
  if (t.limited) {
    const Mask clipped = excess_at_end<Growth>(t, work, i) > 0;
    cut = select(clipped, load(work.cut + i), cut);
    store(cut, work.cut + i);
    store(as_number(clipped), work.clipped + i);
  }
  const StressAtDepth at = Growth::template at<kDigits>(t, cut, work, i);
  store(at.by_temperature, work.log_slope + i);
  store(at.by_depth, work.depth_slope + i);
  store(exponential<kDigits>(cut), work.e_cut + i);
  store(exponential<kDigits>(clamped(at.log_value, -600, 100)), work.stress + i);
}

/// Whether a stress of the pack is limited at the edge and may not be behind it.
HWY_INLINE bool has_limited_rim(const Tables& t, const Work& work, int i) {
  return t.limited_rim && any(load(work.law_base + i) > t.log_limit_at_edge);
}

/// c p up to which the end of a limited rim is sought: at the centre or at the table's end.
HWY_INLINE Pack rim_end(const Tables& t, const Work& work, int i) {
  return least(load(work.scaled_pressure + i), t.maximum_scaled_pressure);
}

/// The stress at the end of a limited rim.
template <PressureGrowth Growth, Digits kDigits>
HWY_INLINE void eval_rim(const Tables& t, Work& work, int i) {
  const Pack u = load(work.rim + i) + 1, depth = logarithm<kDigits>(u);
  const StressAtDepth at = Growth::template at<kDigits>(t, depth, work, i);
  store(depth, work.rim_depth + i);
  store(at.by_temperature, work.rim_log_slope + i);
  store(at.by_depth / u, work.rim_steepness + i);
  store(exponential<kDigits>(clamped(at.log_value, -600, 100)), work.rim_stress + i);
}

/// R and its slope in L, of kPacks packs, which begin at the given lanes. (For two packs each
/// coefficient is loaded once, and their chains of dependent instructions overlap: a contact then
/// takes 0.98 of the time with AVX2.)
template <Digits kDigits, int kPacks>
HWY_INLINE void eval_ratio(const Tables& t, const int* lane, const Work& work, const double* depth,
                           double* ratio, double* ratio_slope) {
  const BivariatePolynomial& r = kDigits == Digits::kFull ? t.ratio : t.coarse_ratio;
  Pack x[kPacks], y[kPacks], value[kPacks], slope[kPacks];
  for (int k = 0; k < kPacks; ++k) {
    const int i = lane[k];
    x[k] = clamped(fused(t.factor_scale, load(work.factor + i), t.factor_offset), -1, 1);
    y[k] = clamped(fused(t.depth_scale, load(depth + i), t.depth_offset), -1, 1);
    value[k] = slope[k] = 0;
  }
  const double* c = r.coefficients.data();
  for (const int length : r.row_length) {
    const double* const end = c + length;
    Pack row[kPacks];
    for (int k = 0; k < kPacks; ++k) row[k] = *c;
    while (++c != end) {
      for (int k = 0; k < kPacks; ++k) row[k] = fused(row[k], y[k], *c);
    }
    for (int k = 0; k < kPacks; ++k) {
      slope[k] = fused(slope[k], x[k], value[k]);
      value[k] = fused(value[k], x[k], row[k]);
    }
  }
  for (int k = 0; k < kPacks; ++k) {
    store(value[k], ratio + lane[k]);
    store(slope[k] * t.factor_scale, ratio_slope + lane[k]);
  }
}

/// The same of all packs that are worked on.
template <Digits kDigits>
HWY_INLINE void eval_ratios(const Tables& t, const ActiveLanes& active, const Work& work,
                            const double* depth, double* ratio, double* ratio_slope) {
  const int* lane = active.begin();
  for (; active.end() - lane >= 2; lane += 2) {
    eval_ratio<kDigits, 2>(t, lane, work, depth, ratio, ratio_slope);
  }
  if (lane != active.end()) eval_ratio<kDigits, 1>(t, lane, work, depth, ratio, ratio_slope);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_CONTACT_SHEAR_BLOCK_INL_H_
