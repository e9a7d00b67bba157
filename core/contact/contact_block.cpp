// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/contact_block.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "core/laws/asperities-inl.h"
#include "core/laws/film-inl.h"
#include "core/laws/heat-inl.h"
#include "core/laws/shear-inl.h"
#include "core/numerics/dispatch.h"
#include "core/numerics/pack-inl.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include <array>
#include <cstdint>
#include <numbers>

#include "core/contact/contact_block.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

using Tables = ContactBlockTables;

/// What one stage leaves to the next. Stages are short loops over the block: a processor then works
/// on several contacts at a time, and all that a stage needs stays in registers.
struct alignas(64) Work {
  using Lanes = ContactLanes;
  Lanes eligible;
  Lanes slide2, log_along, log_across, log_speed2, log_load;
  Lanes film_under_all, load_root;  // h_cen if the film carried all, W^(1/3)
  // Load sharing: r = ln(W_EHL/W), e^(r/3), h_cen/h_cen(r = 0), and the asperities there.
  Lanes asperities, log_share, share_root, thinner, film_ratio, gaussian, inverse, fall, f5_2,
      lowest, last_change;
  Lanes contact_area, asperity_area;
  // Heat: T = base + gain tau_bar.
  Lanes viscous_area, gain, base, log_shear_rate;
  Lanes scaled_pressure, per_scaled;     // c p_max, 1/(c p_max)
  Lanes end, end_growth, end_log_limit;  // s = ln(1 + c p) at the centre or the table's end,
                                         // e^(Z s) - 1 and ln tau_L there
  Lanes all_limit;                       // tau_bar where all sits on tau_L
  // The iteration: T - base and the s where tau meets tau_L; eq 23 at that T; tau at that s.
  Lanes start, rise, cut, pending;
  Lanes law_base, law_base_slope, factor, factor_slope;
  Lanes clipped, e_growth, e_cut, stress, ratio, ratio_slope;
  Lanes mean, change, cut_change;
};

/// Places of a block, in steps of pack_lanes().
class Places {
 public:
  explicit Places(int count) {
    for (int i = 0; i < count; i += pack_lanes()) place_[count_++] = i;
  }
  const int* begin() const { return place_; }
  const int* end() const { return place_ + count_; }
  bool empty() const { return count_ == 0; }
  /// Goes through all places and keeps those for which `stays` is true.
  template <class Function>
  HWY_INLINE void keep(Function&& stays) {
    int kept = 0;
    for (int n = 0; n < count_; ++n) {
      const int i = place_[n];
      place_[kept] = i;
      kept += stays(i) ? 1 : 0;
    }
    count_ = kept;
  }

 private:
  int place_[kBlockContacts];
  int count_ = 0;
};

/// Bounds within which nothing overflows and logarithms keep their digits; and the logarithms of
/// eq 12. (A stage of its own: with the exponentials it would run out of registers.)
HWY_INLINE void take_logarithms(const ContactBlockInputs& in, Work& work, int i) {
  const Pack load_all = load_any(in.load + i);
  const Pack pinion_x = load_any(in.pinion_x + i), pinion_y = load_any(in.pinion_y + i);
  const Pack gear_x = load_any(in.gear_x + i), gear_y = load_any(in.gear_y + i);
  const Pack curvature_x = load_any(in.curvature_x + i), curvature_y = load_any(in.curvature_y + i);
  const Pack mean_x2 = square(0.5 * (pinion_x + gear_x));
  const Pack mean_y2 = square(0.5 * (pinion_y + gear_y));
  const Pack speed2 = entrainment_speed_squared(mean_x2, mean_y2);
  const Pack slide2 = square(pinion_x - gear_x) + square(pinion_y - gear_y);
  const Mask eligible = within(load_all, 1e-10, 1e8) & within(speed2, 1e-14, 1e8) &
                        within(slide2, 1e-18, 1e8) & within(curvature_x, 1e-5, 1e6) &
                        within(curvature_y, 1e-5, 1e6);
  store(as_number(eligible), work.eligible + i);
  store(slide2, work.slide2 + i);
  // 1/R_e = Q_e/U^2, 1/R_s = Q_s/U^2.
  store(logarithm(curvature_along_entrainment(mean_x2, mean_y2, curvature_x, curvature_y)),
        work.log_along + i);
  store(logarithm(curvature_across_entrainment(mean_x2, mean_y2, curvature_x, curvature_y)),
        work.log_across + i);
  store(logarithm(speed2), work.log_speed2 + i);
  store(logarithm(load_all), work.log_load + i);
}

/// Eq 12 under all the load.
HWY_INLINE void film_under_all(const Tables& t, const ContactBlockInputs& in, Work& work, int i) {
  const Pack log_along = load(work.log_along + i), log_load = load(work.log_load + i);
  const Pack log_speed2 = load(work.log_speed2 + i);
  const Pack log_thickness = log_film(t.log_film, log_speed2, log_along - log_speed2, log_load);
  const Mask eligible = (load(work.eligible + i) > 0) & within(log_thickness, -70, 7);
  const Pack film =
      exponential(log_thickness) * side_leakage(log_along - load(work.log_across + i));
  store(as_number(eligible), work.eligible + i);
  store(film, work.film_under_all + i);
  const Pack per_root = exponential((-1.0 / 3) * log_load);
  store(load_any(in.load + i) * square(per_root), work.load_root + i);
  store(t.asperity_load_factor * load_any(in.unit_area + i) * per_root, work.asperities + i);
}

struct ValueAndSlope {
  Pack value, slope;
};

/// P(x) = E(x^2) + x O(x^2), so that the chains of Horner's scheme are half as long.
HWY_INLINE ValueAndSlope polynomial_and_slope(const std::array<double, kAsperityTerms>& c, Pack x) {
  static_assert(kAsperityTerms % 2 == 0);
  const Pack x2 = x * x;
  Pack odd = c[0], even = c[1], odd_slope = c[0], even_slope = c[1];
  odd = fused(odd, x2, c[2]);
  even = fused(even, x2, c[3]);
  for (int j = 4; j < kAsperityTerms; j += 2) {
    odd_slope = fused(odd_slope, x2, odd);
    even_slope = fused(even_slope, x2, even);
    odd = fused(odd, x2, c[j]);
    even = fused(even, x2, c[j + 1]);
  }
  return {fused(odd, x, even), fused(x + x, fused(odd_slope, x, even_slope), odd)};
}

HWY_INLINE Pack polynomial(const std::array<double, kAsperityTerms>& c, Pack x) {
  static_assert(kAsperityTerms % 2 == 0);
  const Pack x2 = x * x;
  Pack even = c[1], odd = c[0];
  for (int j = 2; j < kAsperityTerms; j += 2) {
    odd = fused(odd, x2, c[j]);
    even = fused(even, x2, c[j + 1]);
  }
  return fused(odd, x, even);
}

constexpr double kShareSettled = 2e-6;

/// One Newton step for ln(e^r + W_asp(r)/W) = 0, r = ln(W_EHL/W) (see load_sharing.h). False where
/// no contact of the pack needs another one; their last changes are still to be added.
template <bool kFirst>
HWY_INLINE bool share_step(const Tables& t, Work& work, int i) {
  const Pack ratio_all = load(work.film_under_all + i) * t.inverse_roughness;
  Pack r = 0, third = 1, thinner = 1;
  if (!kFirst) {
    r = load(work.log_share + i);
    third = exponential((1.0 / 3) * r);
    thinner = film_thinning(r);
  }
  const Pack film_ratio = least(ratio_all * thinner, kAsperityEnd);
  const Pack v = 1 / (film_ratio + kAsperityShift);
  const ValueAndSlope p =
      polynomial_and_slope(t.f5_2, fused(v, t.asperity_scale, t.asperity_offset));
  const Pack gaussian = exponential(-0.5 * square(film_ratio));
  const Pack f5_2 = gaussian * square(v) * v * root(v) * p.value;
  const Pack area = square(third), share = area * third;
  const Pack carried = load(work.asperities + i) * area * f5_2;
  const Pack sum = share + carried;
  // fall = -d ln F_5/2 / d lambda; Newton's slope is rising/sum.
  const Pack fall = fused(v, fused(t.asperity_scale * v, p.slope / p.value, 3.5), film_ratio);
  const Pack rising = fused(carried, fused(kFilmLoadExponent * film_ratio, fall, 2.0 / 3), share);
  const Pack lowest = kFirst ? 1.5 * (1 - sum) : load(work.lowest + i);
  // ln(sum): (sum - 1)(sum + 1) 3/(sum^2 + 4 sum + 1) is within 1e-5 of it near 1.
  const Pack over = 3 * (sum - 1) * (sum + 1) * sum;
  const Pack next = clamped(r - over / (rising * fused(sum, sum + 4, 1)), lowest, 0);
  const Pack change = next - r;
  if (kFirst) store(lowest, work.lowest + i);
  store(third, work.share_root + i);
  store(thinner, work.thinner + i);
  store(film_ratio, work.film_ratio + i);
  store(gaussian, work.gaussian + i);
  store(v, work.inverse + i);
  store(fall, work.fall + i);
  store(f5_2, work.f5_2 + i);
  store(change, work.last_change + i);
  const Mask pending = (load(work.eligible + i) > 0) & (ratio_all < kAsperitiesVanish) &
                       ~(size(change) <= kShareSettled);
  // The others stay, so that the last round serves all of the pack.
  store(select(pending, next, r), work.log_share + i);
  return any(pending);
}

HWY_NOINLINE void share_loads(const Tables& t, Places places, Work& work) {
  places.keep([&](int i) HWY_ATTR { return share_step<true>(t, work, i); });
  constexpr int kMostSteps = 8;
  for (int n = 1; n < kMostSteps && !places.empty(); ++n) {
    places.keep([&](int i) HWY_ATTR { return share_step<false>(t, work, i); });
  }
}

/// The contact as it shares its load: eqs 12, 19, 20, 40-42.
HWY_INLINE void part_loads(const Tables& t, const ContactBlockInputs& in,
                           ContactBlockResults& block, Work& work, int i) {
  const Pack film_under_all = load(work.film_under_all + i);
  const Mask alone = film_under_all * t.inverse_roughness >= kAsperitiesVanish;
  Pack change = load(work.last_change + i);
  const Pack film_ratio = load(work.film_ratio + i);
  // Settled, and not beyond the tabulated film ratios unless the asperities have vanished.
  const Mask eligible = (load(work.eligible + i) > 0) &
                        (alone | ((film_ratio < kAsperityEnd) & (size(change) <= kShareSettled)));
  store(as_number(eligible), work.eligible + i);

  // The last change is below 2e-6: it is carried on to second order.
  change = where(~alone, change);
  const Pack third = load(work.share_root + i) * fused(change, fused(change, 1.0 / 18, 1.0 / 3), 1);
  const Pack thinner = load(work.thinner + i) * less_product(change, kFilmLoadExponent, 1);
  const Pack less = kFilmLoadExponent * film_ratio * change;  // lambda_s falls by
  const Pack log_5_2 = load(work.fall + i) * less, log_gaussian = film_ratio * less;
  const Pack f5_2 = load(work.f5_2 + i) * fused(log_5_2, fused(log_5_2, 0.5, 1), 1);
  const Pack gaussian =
      load(work.gaussian + i) * fused(log_gaussian, fused(log_gaussian, 0.5, 1), 1);
  Pack v = load(work.inverse + i);
  v = fused(v * v, less, v);
  const Pack f2 =
      gaussian * square(v) * v * polynomial(t.f2, fused(v, t.asperity_scale, t.asperity_offset));

  const Pack film = film_under_all * thinner;
  const Pack load_root = load(work.load_root + i) * third;
  const Pack contact_area = load_any(in.unit_area + i) * square(load_root);
  const Pack asperity_load = where(~alone, t.asperity_load_factor * contact_area * f5_2);
  const Pack asperity_area = where(~alone, t.asperity_area_factor * contact_area * f2);
  store(load_root, work.load_root + i);
  store(contact_area, work.contact_area + i);
  store(viscous_area(contact_area, asperity_area), work.viscous_area + i);
  store(boundary_friction(t.boundary.tribofilm_shear_strength, asperity_area,
                          t.boundary.asperity_friction_coefficient, asperity_load),
        block.boundary_friction + i);
  store(square(third) * third * load_any(in.load + i), block.film_load + i);
  store(asperity_load, block.asperity_load + i);
  store(film, block.film_thickness + i);
  store(film * t.inverse_roughness, block.film_ratio + i);
  store(load_any(in.unit_pressure + i) * load_root, block.maximum_pressure + i);
}

/// Eqs 18 and 35-39.
HWY_INLINE void connect_heat(const Tables& t, const ContactBlockInputs& in,
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
  const Pack conductance_1 = conductance(t.conductance_factor_1, in.pinion_x, in.pinion_y);
  const Pack conductance_2 = conductance(t.conductance_factor_2, in.gear_x, in.gear_y);
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

/// Eq 18, and logarithms and powers that stay while the temperature is sought.
HWY_INLINE void prepare_heat(const Tables& t, Pack slide, Pack film, Pack pressure,
                             double* shear_rate, Work& work, int i) {
  const double rim_limit = t.shear.lubricant.limiting_shear_stress_at_zero_pressure;
  const Pack scaled = kRoelandsPressureCoefficient * pressure;
  const Pack inverse = 1 / (scaled * film);
  const Pack rate = slide * scaled * inverse;
  store(rate, shear_rate + i);
  store(film * inverse, work.per_scaled + i);
  const Pack end_pressure = least(scaled, t.deepest_pressure);
  const Pack end = logarithm(end_pressure + 1);
  store(logarithm(rate), work.log_shear_rate + i);
  store(scaled, work.scaled_pressure + i);
  store(end, work.end + i);
  store(exponential(t.shear.index * end) - 1, work.end_growth + i);
  if (t.limited) {
    store(logarithm(limiting_shear_stress(rim_limit, t.limit_slope, end_pressure)),
          work.end_log_limit + i);
    store(mean_limiting_shear_stress(rim_limit, t.limit_slope, scaled), work.all_limit + i);
  }
}

/// ln tau = law_base + factor (e^{Z s} - 1) at T = base + rise, with slopes in temperature.
template <Digits kDigits>
HWY_INLINE void take_law(const Tables& t, Work& work, int i) {
  const LogStress<Pack> law = log_stress<kDigits>(
      t.shear, load(work.base + i) + load(work.rise + i), load(work.log_shear_rate + i));
  store(law.factor, work.factor + i);
  store(law.factor_slope, work.factor_slope + i);
  store(law.base, work.law_base + i);
  store(law.base_slope, work.law_base_slope + i);
}

HWY_INLINE Pack excess_at_end(const Work& work, int i) {
  return log_under_pressure(load(work.law_base + i), load(work.factor + i),
                            load(work.end_growth + i)) -
         load(work.end_log_limit + i);
}

/// The stress where it is cut off, at the place where it met tau_L or at the centre.
template <Digits kDigits>
HWY_INLINE void take_stress(const Tables& t, Work& work, int i) {
  Pack cut = load(work.end + i);
  if (t.limited) {
    const Mask clipped = excess_at_end(work, i) > 0;
    cut = select(clipped, load(work.cut + i), cut);
    store(cut, work.cut + i);
    store(as_number(clipped), work.clipped + i);
  }
  const Pack e_growth = exponential<kDigits>(t.shear.index * cut);
  store(e_growth, work.e_growth + i);
  store(exponential<kDigits>(cut), work.e_cut + i);
  const Pack log_value =
      log_under_pressure(load(work.law_base + i), load(work.factor + i), e_growth - 1);
  store(exponential<kDigits>(clamped(log_value, -600, 100)), work.stress + i);
}

/// R and its slope in L.
template <Digits kDigits>
HWY_INLINE void take_ratio(const Tables& t, Work& work, int i) {
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
/// tau_bar is stationary in s at s*: with the Newton change d = -e/e' its value there is
/// tau_bar + (d tau_bar/ds) d/2 to third order, which leaves one equation for T. H grows like
/// 1 + a (T - base) with the steepness a = -d ln tau_bar/dT, whence a curvature H' - 1 for Halley's
/// correction. The logarithms are rational functions with the same root and slope there.
struct Step {
  Pack change;      // of y
  Pack cut_change;  // of s
  Pack mean;        // tau_bar
  Pack per_slope;   // 1/e' where the cut moves
};

template <Digits kDigits>
HWY_INLINE Step step_from(const Tables& t, const Work& work, int i) {
  const Pack scaled = load(work.scaled_pressure + i), per_scaled = load(work.per_scaled + i);
  const Pack stress = load(work.stress + i), ratio = load(work.ratio + i);
  const Pack factor_slope = load(work.factor_slope + i), rise = load(work.rise + i);
  const Pack e_growth = load(work.e_growth + i), e_cut = load(work.e_cut + i);
  Mask clipped = nowhere(), all_limited = nowhere();
  if (t.limited) {
    clipped = load(work.clipped + i) > 0;
    all_limited = load(work.law_base + i) > t.log_limit_at_rim;
  }
  // Where the stress is not cut off, q is c p_max: e_cut - 1 has lost digits of small ones.
  Pack q = e_cut - 1;
  if (kDigits == Digits::kFull) q = least(select(clipped, q, scaled), scaled);
  const Pack part = q * per_scaled, part2 = part * part;
  const Pack weighted = stress * part2;
  // d ln tau(s)/dT.
  const Pack log_slope = fused(factor_slope, e_growth - 1, load(work.law_base_slope + i));
  Step step;
  step.change = step.cut_change = 0;
  step.mean = weighted * ratio;
  Pack mean_slope = weighted * fused(ratio, log_slope, load(work.ratio_slope + i) * factor_slope);
  Pack cut_steepness = 0;  // -1/e' where the cut moves
  if (t.limited) {
    const double rim_limit = t.shear.lubricant.limiting_shear_stress_at_zero_pressure;
    const Pack limit = limiting_shear_stress(rim_limit, t.limit_slope, q);
    const Pack on_limit = fused((t.limit_slope * 2 / 3) * scaled, less_product(part2, part, 1),
                                rim_limit * (1 - part2));
    const Fraction e = alike(stress, limit);
    const Pack e_slope_limit =
        greatest(less_product(t.limit_slope, e_cut,
                              load(work.factor + i) * t.shear.index * e_growth * limit),
                 0.05 * limit);
    const Pack inverse = where(clipped & ~all_limited, -limit / (e.under * e_slope_limit));
    step.cut_change = e.over * inverse;
    cut_steepness = e.under * inverse;
    const Pack rate = part * (e_cut * per_scaled);          // (d tau_bar/ds)/2 per excess stress
    const Pack mixed = (rate + rate) * stress * log_slope;  // d2 tau_bar/(ds dT)
    step.mean = fused(rate * (stress - limit), step.cut_change,
                      step.mean + (kDigits == Digits::kFull ? where(clipped, on_limit) : on_limit));
    mean_slope = fused(mixed, step.cut_change, mean_slope);
    step.mean = select(all_limited, load(work.all_limit + i), step.mean);
    mean_slope = where(~all_limited, mean_slope);
  }
  step.per_slope = -cut_steepness;
  if (t.isothermal) return step;
  const Fraction h = alike(rise, load(work.gain + i) * step.mean);
  const Pack less = least(0.5 * step.mean, mean_slope * rise);  // tau_bar (1 - H')
  const Pack slope = step.mean - less;
  const Pack quotient = 1 / (h.under * slope * step.mean);
  const Pack newton = clamped(-(h.over * step.mean) * (step.mean * quotient), -2, 2);
  step.change = newton * fused(newton, 0.5 * less * (h.under * step.mean) * quotient, 1);
  step.cut_change = fused(log_slope * rise * step.change, cut_steepness, step.cut_change);
  return step;
}

HWY_INLINE Pack room_of(const Tables& t, const Work& work, int i) {
  return greatest(t.hottest - load(work.base + i), 1e-3);
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
  store(load(work.eligible + i), work.pending + i);
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

/// ln tau = ln tau_L for s: with tau_L as at the end, then as at that s.
HWY_INLINE void start_cut(const Tables& t, Work& work, int i) {
  constexpr Digits kHalf = Digits::kHalf;
  const Pack per_factor = 1 / load(work.factor + i), base = load(work.law_base + i);
  const Pack end = load(work.end + i);
  const auto meeting = [&](Pack log_limit) HWY_ATTR {
    const Pack folds = greatest((log_limit - base) * per_factor, 1e-3);
    return least(logarithm<kHalf>(folds + 1) * (1 / t.shear.index), end);
  };
  const Pack cut = meeting(load(work.end_log_limit + i));
  const Pack limit = limiting_shear_stress(t.shear.lubricant.limiting_shear_stress_at_zero_pressure,
                                           t.limit_slope, exponential<kHalf>(cut) - 1);
  store(meeting(logarithm<kHalf>(limit)), work.cut + i);
}

/// Takes a step with half of the digits. False when none of the pack needs another.
HWY_INLINE bool move(const Tables& t, Work& work, int i) {
  constexpr double kClose = 1.5e-3, kCutClose = 4e-3;
  const Pack rise = load(work.rise + i), cut = load(work.cut + i), end = load(work.end + i);
  Mask pending = load(work.pending + i) > 0;
  const Step step = step_from<Digits::kHalf>(t, work, i);
  if (!t.isothermal) {
    // e^x nearly: 1 + x + x^2/2 upwards, its inverse with -x downwards.
    const Pack up = fused(size(step.change), fused(size(step.change), 0.5, 1), 1);
    const Pack next = least(select(step.change < 0, rise / up, rise * up), room_of(t, work, i));
    store(select(pending, next, rise), work.rise + i);
  }
  const Pack next = least(greatest(cut + step.cut_change, 0.25 * cut), end);
  store(select(pending, next, cut), work.cut + i);
  pending = pending & ~((size(step.change) <= kClose) & (size(step.cut_change) <= kCutClose));
  store(as_number(pending), work.pending + i);
  return any(pending);
}

/// The same with all digits: contacts whose step is small stay, and it is still to be added.
HWY_INLINE bool move_finely(const Tables& t, Work& work, int i) {
  // Newton's error is the square of the step, times a curvature that grows where stress and limit
  // meet at a small angle.
  constexpr double kSettled = 3e-6, kCutSettled = 3.6e-6;
  const Pack rise = load(work.rise + i), cut = load(work.cut + i);
  const Step step = step_from<Digits::kFull>(t, work, i);
  const Pack weight = fused(4, step.per_slope, 1);
  const Mask pending =
      (load(work.eligible + i) > 0) &
      ~((size(step.change) <= kSettled) & (size(step.cut_change) * weight <= kCutSettled));
  store(step.mean, work.mean + i);
  store(step.change, work.change + i);
  store(step.cut_change, work.cut_change + i);
  store(as_number(pending), work.pending + i);
  if (!any(pending)) return false;
  const Pack next = rise * fused(step.change, fused(step.change, 0.5, 1), 1);
  store(select(pending, clamped(next, 0.1 * rise, room_of(t, work, i)), rise), work.rise + i);
  const Pack next_cut = least(greatest(cut + step.cut_change, 0.25 * cut), load(work.end + i));
  store(select(pending, next_cut, cut), work.cut + i);
  return true;
}

template <Digits kDigits>
HWY_NOINLINE void take_all(const Tables& t, const Places& places, bool first, Work& work) {
  for (const int i : places) take_law<kDigits>(t, work, i);
  if (first && t.limited) {
    for (const int i : places) start_cut(t, work, i);
  }
  for (const int i : places) take_stress<kDigits>(t, work, i);
  for (const int i : places) take_ratio<kDigits>(t, work, i);
}

HWY_NOINLINE void approach(const Tables& t, Places places, Work& work) {
  for (const int i : places) start(t, work, i);
  constexpr int kMostSteps = 16;
  for (int n = 0; n < kMostSteps && !places.empty(); ++n) {
    take_all<Digits::kHalf>(t, places, n == 0, work);
    places.keep([&](int i) HWY_ATTR { return move(t, work, i); });
  }
}

HWY_NOINLINE void settle(const Tables& t, Places places, Work& work) {
  for (int n = 0; n < 4 && !places.empty(); ++n) {
    take_all<Digits::kFull>(t, places, false, work);
    places.keep([&](int i) HWY_ATTR { return move_finely(t, work, i); });
  }
}

/// Proofs, and what follows from the stress.
HWY_INLINE void conclude(const Tables& t, ContactBlockResults& block, const Work& work, int i) {
  const Pack base = load(work.base + i), rise = load(work.rise + i);
  const Pack change = load(work.change + i), scaled = load(work.scaled_pressure + i);
  const Pack factor = load(work.factor + i);
  const Pack next_rise = rise * fused(change, fused(change, 0.5, 1), 1);
  const Pack temperature = base + next_rise;
  Mask solved = (load(work.eligible + i) > 0) & ~(load(work.pending + i) > 0);
  // Inside the table.
  solved = solved & (size(fused(t.factor_scale, factor, t.factor_offset)) <= 1) & (factor > 0.01) &
           (temperature <= t.hottest);
  const Mask whole = scaled < t.deepest_pressure;
  Pack share = 0, centre = 0;
  if (t.limited) {
    // One place at most where stress and limit meet, and not within rounding of none.
    const Pack excess_end = excess_at_end(work, i);
    const Pack excess_rim = load(work.law_base + i) - t.log_limit_at_rim;
    const Mask clipped = excess_end > 0, all_limited = excess_rim > 0;
    solved = solved & (size(excess_rim) > 1e-8) & (size(excess_end) > 1e-8);
    const Mask rising = factor >= t.monotone_factor;
    solved = solved & (t.falls_then_rises ? rising | ~all_limited : rising);
    const Mask touched = clipped | all_limited;
    const Pack end = load(work.end + i), cut_change = load(work.cut_change + i);
    const Pack cut = load(work.cut + i) + cut_change;
    const Mask inside = (cut > 1e-2) & (cut <= end);
    solved = solved & (whole | touched) & (inside | all_limited | ~clipped);
    const Pack q = fused(load(work.e_cut + i), fused(cut_change, fused(cut_change, 0.5, 1), 1), -1);
    const Pack part = least(q * load(work.per_scaled + i), 1);
    share = select(all_limited, 1, where(clipped, (1 - part) * (1 + part)));
    centre = as_number(touched);
    // One equilibrium: the rise cannot leave the temperatures for which that is proved.
    const Pack most = fused(load(work.gain + i), load(work.all_limit + i), base);
    solved = solved & (most <= t.proved_temperature);
  } else {
    solved = solved & whole;
  }
  const Pack stress = t.isothermal ? load(work.mean + i) : next_rise / load(work.gain + i);
  const Pack viscous = viscous_friction(load(work.viscous_area + i), stress);
  const Pack total = friction(viscous, load(block.boundary_friction + i));
  solved = solved & (total < 1e200);  // also false for NaN
  store(viscous, block.viscous_friction + i);
  store(total, block.friction + i);
  store(temperature, block.contact_temperature + i);
  store(stress, block.mean_shear_stress + i);
  store(share, block.limited_area_share + i);
  store(centre, block.limited_at_centre + i);
  store(as_number(solved), block.solved + i);
}

}  // namespace

void solve_block(const Tables& tables, int count, const ContactBlockInputs& in,
                 ContactBlockResults& block) {
  Work work;
  const Places places(count);
  for (const int i : places) take_logarithms(in, work, i);
  for (const int i : places) film_under_all(tables, in, work, i);
  share_loads(tables, places, work);
  for (const int i : places) part_loads(tables, in, block, work, i);
  for (const int i : places) connect_heat(tables, in, block, work, i);
  for (const int i : places) {
    prepare_heat(tables, load(block.sliding_speed + i), load(block.film_thickness + i),
                 load(block.maximum_pressure + i), block.shear_rate, work, i);
  }
  approach(tables, places, work);
  settle(tables, places, work);
  for (const int i : places) conclude(tables, block, work, i);
}

void sample_rises(const Tables& tables, const StartSamples& in, double* rise) {
  Work work;
  alignas(64) ContactLanes ignored;
  const Places places(kBlockContacts);
  for (const int i : places) {
    store(1, work.eligible + i);
    store(tables.inlet_temperature, work.base + i);
    store(0, work.start + i);
    store(load(in.gain + i), work.gain + i);
    prepare_heat(tables, load(in.shear_rate + i), 1, load(in.pressure + i), ignored, work, i);
  }
  approach(tables, places, work);
  for (const int i : places) store(load(work.rise + i), rise + i);
}

void exponentials(const double* x, double* y, std::size_t n) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(kTag)) {
    hn::Store(hn::Exp(kTag, hn::Load(kTag, x + i)), kTag, y + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {

void solve_contact_block(InstructionSet instruction_set, const ContactBlockTables& tables,
                         int count, const ContactBlockInputs& in, ContactBlockResults& out) {
  TRIBODYN_RETURN_WITH(instruction_set, solve_block, tables, count, in, out)
}

void sample_rises(InstructionSet instruction_set, const ContactBlockTables& tables,
                  const StartSamples& samples, double* rise) {
  TRIBODYN_RETURN_WITH(instruction_set, sample_rises, tables, samples, rise)
}

void vector_exponential(InstructionSet instruction_set, const double* x, double* y, std::size_t n) {
  TRIBODYN_RETURN_WITH(instruction_set, exponentials, x, y, n)
}

}  // namespace tribodyn
#endif
