// The contact temperatures of a block of contacts.
// Compiled once per instruction set by contact_block.cpp.
#if defined(TRIBODYN_CORE_CONTACT_HEAT_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_CONTACT_HEAT_BLOCK_INL_H_
#undef TRIBODYN_CORE_CONTACT_HEAT_BLOCK_INL_H_
#else
#define TRIBODYN_CORE_CONTACT_HEAT_BLOCK_INL_H_
#endif

#include <hwy/highway.h>

#include "core/contact/limited_rim-inl.h"
#include "core/contact/shear_block-inl.h"
#include "core/laws/heat-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

/// T_c as a line over the mean stress, and the sliding speed.
HWY_INLINE void eval_thermal_network(const Tables& t, const ContactBlockInputs& in,
                                     ContactBlockResults& block, Work& work, int i) {
  const Pack film = load(block.film_thickness + i);
  const Pack contact_area = load(work.contact_area + i);
  // The semi-axes and the area are those at 1 N: A sqrt(U/l) grows as (W^(1/3))^(3/2) with the
  // load.
  const Pack per_x = load_any(in.per_semi_x + i), per_y = load_any(in.per_semi_y + i);
  const Pack load_root = load(work.load_root + i);
  const Pack area = load_any(in.unit_area + i) * load_root * root(load_root);
  const auto conductance = [&](double factor, const double* x, const double* y) HWY_ATTR {
    return moving_source_conductance(
        factor, area, speed_per_length(load_any(x + i), load_any(y + i), per_x, per_y));
  };
  const Pack conductance_1 = conductance(t.conductance_factor_1, in.x_1, in.y_1);
  const Pack conductance_2 = conductance(t.conductance_factor_2, in.x_2, in.y_2);
  const double oil_conductivity = t.shear.lubricant.thermal_conductivity;
  const Pack slide = root(load(work.slide2 + i));
  ThermalLine<Pack> temperature{t.inlet_temperature, 0};
  if (!t.isothermal) {
    temperature =
        contact_temperature(t.inlet_temperature,
                            slide * flash_resistance(2 * oil_conductivity * contact_area, film,
                                                     conductance_1, conductance_2),
                            load(block.boundary_friction + i), load(work.viscous_area + i),
                            oil_rise_per_stress(slide, film, oil_conductivity));
  }
  store(temperature.base, work.base + i);
  store(temperature.gain, work.gain + i);
  store(load_any(in.start_temperature + i), work.start + i);
  store(slide, block.sliding_speed + i);
}

/// ln(x/y) to 1e-5 where they are alike, with the right sign everywhere, as parts of a fraction.
struct Fraction {
  Pack over, under;
};
HWY_INLINE Fraction alike(Pack x, Pack y) {
  const Pack x2 = x * x, y2 = y * y;
  return {3 * (x2 - y2), fused(4 * x, y, x2 + y2)};
}

/// One step towards the temperature and towards the place where the stress meets tau_L,
///
///   H(y) = y - ln(gain tau_bar(T, s*(T))) = 0,  y = ln(T - base),     e(s) = ln(tau/tau_L) = 0.
///
///  1. tau_bar is stationary in s at s*: with the Newton change d = -e/e' its value there is
///     tau_bar + (d tau_bar/ds) d/2 to third order, which leaves one equation for T.
///  2. Newton's change n = -H/H' of y, at most 2, is corrected to n (1 - n H''/(2 H')), Halley's to
///     second order. H' grows like 1 + a (T - base) with the steepness a = -d ln tau_bar/dT, whence
///     H'' = H' - 1.
///  3. s changes by d and by the shift of s* with T.
///  4. A limited rim ends at x* = c p, where tau first meets tau_L: x is found as s* is, by the
///  step
///     of limited_rim-inl.h.
/// The logarithms are rational functions with the same root and slope there. (J. F. Traub,
/// Iterative Methods for the Solution of Equations, 1964, for Halley's method and its kin.)
struct Step {
  Pack change;       // of y
  Pack cut_change;   // of s
  Pack mean;         // tau_bar
  Pack per_slope;    // 1/e' where the cut moves
  Pack rim_change;   // of x
  Pack rim_unsure;   // a size of that, and 1 where all_limited is not proved yet
  Mask all_limited;  // tau > tau_L everywhere
};

/// The part of a limited rim in a step.
struct Rim {
  Mask ends;              // tau_L holds up to x*, not up to the centre
  Pack mean, mean_slope;  // what that changes in tau_bar and d tau_bar/dT
  Pack change;            // of x at this T
  Pack change_by_rise;    // dx*/dT
  Pack unsure_by_change;  // Step::rim_unsure by rim_change
  Mask unproved;          // no x* was found, but that there is none is not proved
};
HWY_INLINE Rim rim_step(const Tables& t, const Work& work, int i) {
  const double edge_limit = t.shear.lubricant.limiting_shear_stress_at_zero_pressure;
  const Pack scaled = load(work.scaled_pressure + i), per_scaled = load(work.per_scaled + i);
  const Pack x = load(work.rim + i), stress = load(work.rim_stress + i);
  const Pack limit = limiting_shear_stress(edge_limit, t.limit_slope, x);
  const LimitExcess h(stress, load(work.rim_steepness + i), limit, t.limit_slope);
  const RimStep step(h);
  const Mask limited = load(work.law_base + i) > t.log_limit_at_edge;
  const Mask clipped = load(work.clipped + i) > 0;
  const Mask met = step.meets & (x + step.change <= rim_end(t, work, i));
  Rim out;
  out.ends = limited & (met | ~clipped);
  const Pack part = x * per_scaled, part2 = part * part;
  const Pack moved = part * (step.change * per_scaled);
  const Pack ratio = load(work.rim_ratio + i), log_slope = load(work.rim_log_slope + i);
  const Pack on_limit = part2 * mean_limiting_shear_stress(edge_limit, t.limit_slope, x);
  out.mean = where(out.ends, on_limit - stress * part2 * ratio - h.value * moved);
  const Pack slope = fused(
      part2, fused(ratio, log_slope, load(work.rim_ratio_slope + i) * load(work.factor_slope + i)),
      2 * moved * log_slope);
  out.mean_slope = where(out.ends, -(stress * slope));
  out.change = where(limited, step.change);
  const Pack per_fall = 1 / greatest(step.fall, 0.05 * t.limit_slope);
  out.change_by_rise = where(out.ends, stress * log_slope * per_fall);
  out.unsure_by_change = where(out.ends, fused(h.curvature, per_fall, per_scaled));
  // h is above its tangent.
  const Pack drop = greatest(h.slope * x, h.slope * (x - scaled));
  out.unproved = limited & ~out.ends & ~(h.value - drop > 1e-2 * limit);
  return out;
}

/// kKept: the stress of the step is a result, not only a way to one.
template <bool kKept>
HWY_INLINE Step halley_step(const Tables& t, const Work& work, int i) {
  const Pack scaled = load(work.scaled_pressure + i), per_scaled = load(work.per_scaled + i);
  const Pack stress = load(work.stress + i), ratio = load(work.ratio + i);
  const Pack factor_slope = load(work.factor_slope + i), rise = load(work.rise + i);
  const Pack e_cut = load(work.e_cut + i), cut_room = load(work.end + i) - load(work.cut + i);
  Mask clipped = nowhere(), all_limited = nowhere();
  if (t.limited) {
    clipped = load(work.clipped + i) > 0;
    all_limited = load(work.law_base + i) > t.log_limit_at_edge;
  }
  Rim rim;
  const bool has_rim = has_limited_rim(t, work, i);
  if (has_rim) {
    rim = rim_step(t, work, i);
    all_limited = all_limited & ~rim.ends;
  }
  // Where the stress is not cut off, q is c p_max: e_cut - 1 has lost digits of small ones.
  Pack q = e_cut - 1;
  if (kKept) q = least(select(clipped, q, scaled), scaled);
  const Pack part = q * per_scaled, part2 = part * part;
  const Pack weighted = stress * part2;
  const Pack log_slope = load(work.log_slope + i);
  Step step;
  step.change = step.cut_change = step.rim_change = step.rim_unsure = 0;
  step.all_limited = all_limited;
  step.mean = weighted * ratio;
  Pack mean_slope = weighted * fused(ratio, log_slope, load(work.ratio_slope + i) * factor_slope);
  Pack cut_steepness = 0;  // -1/e' where the cut moves
  if (t.limited) {
    const double rim_limit = t.shear.lubricant.limiting_shear_stress_at_zero_pressure;
    const Pack limit = limiting_shear_stress(rim_limit, t.limit_slope, q);
    const Pack on_limit = fused((t.limit_slope * 2 / 3) * scaled, less_product(part2, part, 1),
                                rim_limit * (1 - part2));
    const Fraction e = alike(stress, limit);
    const Pack e_slope = less_product(t.limit_slope, e_cut, load(work.depth_slope + i) * limit);
    const Pack e_slope_limit = greatest(e_slope, 0.05 * limit);
    Mask moves = clipped & ~all_limited;
    if (has_rim) {  // in the rim the cut returns to the end
      const Mask strays = moves & rim.ends & (e_slope <= 0);
      step.cut_change = where(strays, cut_room);
      moves = moves & ~strays;
      step.mean = step.mean + rim.mean;
      mean_slope = mean_slope + rim.mean_slope;
      step.rim_change = rim.change;
    }
    const Pack inverse = where(moves, -limit / (e.under * e_slope_limit));
    const Pack cut_change = e.over * inverse;
    step.cut_change = step.cut_change + cut_change;
    cut_steepness = e.under * inverse;
    const Pack rate = part * (e_cut * per_scaled);          // (d tau_bar/ds)/2 per excess stress
    const Pack mixed = (rate + rate) * stress * log_slope;  // d2 tau_bar/(ds dT)
    step.mean = fused(rate * (stress - limit), cut_change,
                      step.mean + (kKept ? where(clipped, on_limit) : on_limit));
    mean_slope = fused(mixed, cut_change, mean_slope);
    step.mean = select(all_limited, load(work.all_limit + i), step.mean);
    mean_slope = where(~all_limited, mean_slope);
  }
  step.per_slope = -cut_steepness;
  if (!t.isothermal) {
    const Fraction h = alike(rise, load(work.gain + i) * step.mean);
    const Pack less = least(0.5 * step.mean, mean_slope * rise);  // tau_bar (1 - H')
    const Pack slope = step.mean - less;
    const Pack quotient = 1 / (h.under * slope * step.mean);
    const Pack newton = clamped(-(h.over * step.mean) * (step.mean * quotient), -2, 2);
    step.change = newton * fused(newton, 0.5 * less * (h.under * step.mean) * quotient, 1);
    step.cut_change = fused(log_slope * rise * step.change, cut_steepness, step.cut_change);
  }
  if (has_rim) {
    step.rim_change = fused(rim.change_by_rise * rise, step.change, step.rim_change);
    step.rim_unsure = fused(size(step.rim_change), rim.unsure_by_change, as_number(rim.unproved));
  }
  return step;
}

HWY_INLINE Pack room_of(const Tables& t, const Work& work, int i) {
  return greatest(t.maximum_temperature - load(work.base + i), 1e-3);
}

/// Chebyshev polynomials to the third degree.
struct Cubic {
  Pack one, two, three;

  HWY_INLINE Pack of(double c0, const double* c, int degree) const {
    Pack sum = c0;
    if (degree > 0) sum = fused(one, c[0], sum);
    if (degree > 1) sum = fused(two, c[1], sum);
    if (degree > 2) sum = fused(three, c[2], sum);
    return sum;
  }
};
HWY_INLINE Cubic cubic(Pack x) {
  x = clamped(x, -1.1, 1.1);
  const Pack x2 = x * x;
  return {x, fused(2, x2, -1), x * fused(4, x2, -3)};
}

/// T - base as StartFit has it.
HWY_INLINE void start(const Tables& t, Work& work, int i) {
  constexpr Digits kHalf = Digits::kHalf;
  store(load(work.end + i), work.cut + i);
  store(load(work.in_range + i), work.pending + i);
  if (t.isothermal) {
    store(0, work.rise + i);
    return;
  }
  const Pack given = load(work.start + i) - load(work.base + i);
  const Mask warm = given > 0;
  Pack rise = 30;
  if (any(~warm) && t.limited) {
    const Pack most = load(work.gain + i) * load(work.all_limit + i);
    rise = least(rise, 0.4 * most);
    if (t.start_fitted) {
      const StartFit& f = t.start;
      const double* c = f.coefficients.data();
      const Cubic x = cubic(fused(load(work.log_shear_rate + i), f.scale[0], f.offset[0]));
      const Cubic y = cubic(fused(load(work.end + i), f.scale[1], f.offset[1]));
      const Cubic z = cubic(fused(logarithm<kHalf>(most), f.scale[2], f.offset[2]));
      // Coefficients by degree in x, then y, then z, together at most 3.
      Pack sum = z.of(c[0], c + 1, 3);
      sum = fused(y.one, z.of(c[4], c + 5, 2), sum);
      sum = fused(y.two, z.of(c[7], c + 8, 1), sum);
      sum = fused(y.three, c[9], sum);
      Pack in_one = z.of(c[10], c + 11, 2);
      in_one = fused(y.one, z.of(c[13], c + 14, 1), in_one);
      in_one = fused(y.two, c[15], in_one);
      sum = fused(x.one, in_one, sum);
      sum = fused(x.two, fused(y.one, c[18], z.of(c[16], c + 17, 1)), sum);
      sum = fused(x.three, c[19], sum);
      rise = most / (exponential<kHalf>(clamped(sum, -8, 12)) + 1);
    }
  }
  store(least(select(warm, given, rise), room_of(t, work, i)), work.rise + i);
}

/// The first x at which tau = tau_L, by the step from the edge.
template <PressureGrowth Growth>
HWY_INLINE void start_rim(const Tables& t, Work& work, int i) {
  constexpr Digits kHalf = Digits::kHalf;
  const StressAtDepth at = Growth::template at<kHalf>(t, 0, work, i);
  const Pack stress = exponential<kHalf>(clamped(at.log_value, -600, 100));
  const double limit = t.shear.lubricant.limiting_shear_stress_at_zero_pressure;
  const RimStep step(LimitExcess(stress, at.by_depth, limit, t.limit_slope));
  store(clamped(step.change, 1e-9, rim_end(t, work, i)), work.rim + i);
}

/// ln tau = ln tau_L for s: with tau_L as at the end, then as at that s.
template <PressureGrowth Growth>
HWY_INLINE void start_cut(const Tables& t, Work& work, int i) {
  constexpr Digits kHalf = Digits::kHalf;
  const Pack end = load(work.end + i);
  const auto depth = Growth::depth_function(t, work, i);
  const Pack cut = least(depth.of(load(work.end_log_limit + i)), end);
  const Pack limit = limiting_shear_stress(t.shear.lubricant.limiting_shear_stress_at_zero_pressure,
                                           t.limit_slope, exponential<kHalf>(cut) - 1);
  store(least(depth.of(logarithm<kHalf>(limit)), end), work.cut + i);
}

/// Leaves what certify() makes the results of.
HWY_INLINE void keep_step(const Step& step, Work& work, int i) {
  store(step.mean, work.mean + i);
  store(step.change, work.change + i);
  store(step.cut_change, work.cut_change + i);
  store(step.rim_change, work.rim_change + i);
  store(as_number(step.all_limited), work.all_limited + i);
}

HWY_INLINE void move_rim(const Tables& t, const Step& step, Mask stays, Work& work, int i) {
  const Pack rim = load(work.rim + i);
  const Pack next = clamped(rim + step.rim_change, 0.25 * rim, rim_end(t, work, i));
  store(select(stays, rim, next), work.rim + i);
}

/// Takes a step with half of the digits. Returns false if none of the pack needs another. kKept:
/// contacts whose step is small stay, and it is still to be added; otherwise they take it.
template <bool kKept>
HWY_INLINE bool take_coarse_step(const Tables& t, Work& work, int i) {
  constexpr double kClose = kKept ? 5e-4 : 1.5e-3, kCutClose = kKept ? 1e-3 : 4e-3;
  const Pack rise = load(work.rise + i), cut = load(work.cut + i), end = load(work.end + i);
  Mask pending = load(work.pending + i) > 0;
  const Step step = halley_step<kKept>(t, work, i);
  const Mask moves = pending;
  pending = pending & ~((size(step.change) <= kClose) & (size(step.cut_change) <= kCutClose) &
                        (step.rim_unsure <= kCutClose));
  if (kKept) keep_step(step, work, i);
  const Mask stays = kKept ? ~pending : ~moves;
  if (!t.isothermal) {
    // e^x nearly: 1 + x + x^2/2 upwards, its inverse with -x downwards.
    const Pack up = fused(size(step.change), fused(size(step.change), 0.5, 1), 1);
    const Pack next = least(select(step.change < 0, rise / up, rise * up), room_of(t, work, i));
    store(select(stays, rise, next), work.rise + i);
  }
  const Pack next = least(greatest(cut + step.cut_change, 0.25 * cut), end);
  store(select(stays, cut, next), work.cut + i);
  if (t.limited_rim) move_rim(t, step, stays, work, i);
  store(as_number(pending), work.pending + i);
  return any(pending);
}

/// The same with all digits. Contacts whose step is small stay, and it is still to be added.
HWY_INLINE bool take_fine_step(const Tables& t, Work& work, int i) {
  // Newton's error is the square of the step, times a curvature that grows where stress and limit
  // meet at a small angle.
  constexpr double kSettled = 3e-6, kCutSettled = 3.6e-6;
  const Pack rise = load(work.rise + i), cut = load(work.cut + i);
  const Step step = halley_step<true>(t, work, i);
  const Pack weight = fused(4, step.per_slope, 1);
  const Mask pending =
      (load(work.in_range + i) > 0) &
      ~((size(step.change) <= kSettled) & (size(step.cut_change) * weight <= kCutSettled) &
        (step.rim_unsure <= kCutSettled));
  keep_step(step, work, i);
  store(as_number(pending), work.pending + i);
  if (!any(pending)) return false;
  const Pack next = rise * fused(step.change, fused(step.change, 0.5, 1), 1);
  store(select(pending, clamped(next, 0.1 * rise, room_of(t, work, i)), rise), work.rise + i);
  const Pack next_cut = least(greatest(cut + step.cut_change, 0.25 * cut), load(work.end + i));
  store(select(pending, next_cut, cut), work.cut + i);
  if (t.limited_rim) move_rim(t, step, ~pending, work, i);
  return true;
}

template <PressureGrowth Growth, Digits kDigits>
HWY_NOINLINE void eval_all(const Tables& t, const ActiveLanes& active, bool first, Work& work) {
  for (const int i : active) eval_rheology<kDigits>(t, work, i);
  if (first && t.limited) {
    for (const int i : active) start_cut<Growth>(t, work, i);
  }
  for (const int i : active) eval_stress<Growth, kDigits>(t, work, i);
  eval_ratios<kDigits>(t, active, work, work.cut, work.ratio, work.ratio_slope);
  if (!t.limited_rim) return;
  if (first) {
    for (const int i : active) start_rim<Growth>(t, work, i);
  }
  ActiveLanes rims = active;
  rims.keep([&](int i) HWY_ATTR { return has_limited_rim(t, work, i); });
  for (const int i : rims) eval_rim<Growth, kDigits>(t, work, i);
  eval_ratios<kDigits>(t, rims, work, work.rim_depth, work.rim_ratio, work.rim_ratio_slope);
}

/// kKept: solve_fine() does not follow.
template <PressureGrowth Growth, bool kKept>
HWY_NOINLINE void solve_coarse(const Tables& t, ActiveLanes active, Work& work) {
  for (const int i : active) start(t, work, i);
  constexpr int kMostSteps = 16;
  for (int n = 0; n < kMostSteps && !active.empty(); ++n) {
    eval_all<Growth, Digits::kHalf>(t, active, n == 0, work);
    active.keep([&](int i) HWY_ATTR { return take_coarse_step<kKept>(t, work, i); });
  }
}

template <PressureGrowth Growth>
HWY_NOINLINE void solve_fine(const Tables& t, ActiveLanes active, Work& work) {
  for (int n = 0; n < 4 && !active.empty(); ++n) {
    eval_all<Growth, Digits::kFull>(t, active, false, work);
    active.keep([&](int i) HWY_ATTR { return take_fine_step(t, work, i); });
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_CONTACT_HEAT_BLOCK_INL_H_
