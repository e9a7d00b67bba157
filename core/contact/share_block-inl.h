// How film and asperities share the loads of a block of contacts.
// Compiled once per instruction set by contact_block.cpp.
#if defined(TRIBODYN_CORE_CONTACT_SHARE_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_CONTACT_SHARE_BLOCK_INL_H_
#undef TRIBODYN_CORE_CONTACT_SHARE_BLOCK_INL_H_
#else
#define TRIBODYN_CORE_CONTACT_SHARE_BLOCK_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>

#include "core/contact/block_work-inl.h"
#include "core/laws/asperities-inl.h"
#include "core/laws/film-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

/// Bounds within which nothing overflows and logarithms keep their digits; and the logarithms of
/// eq 12. (A stage of its own: with the exponentials it would run out of registers.)
template <Digits kDigits>
HWY_INLINE void eval_logarithms(const ContactBlockInputs& in, Work& work, int i) {
  const Pack load_all = load_any(in.load + i);
  const Pack x_1 = load_any(in.x_1 + i), y_1 = load_any(in.y_1 + i);
  const Pack x_2 = load_any(in.x_2 + i), y_2 = load_any(in.y_2 + i);
  const Pack curvature_x = load_any(in.curvature_x + i), curvature_y = load_any(in.curvature_y + i);
  const Pack mean_x2 = square(0.5 * (x_1 + x_2));
  const Pack mean_y2 = square(0.5 * (y_1 + y_2));
  const Pack speed2 = entrainment_speed_squared(mean_x2, mean_y2);
  const Pack slide2 = square(x_1 - x_2) + square(y_1 - y_2);
  const Mask in_range = within(load_all, 1e-10, 1e8) & within(speed2, 1e-14, 1e8) &
                        within(slide2, 1e-18, 1e8) & within(curvature_x, 1e-5, 1e6) &
                        within(curvature_y, 1e-5, 1e6);
  store(as_number(in_range), work.in_range + i);
  store(slide2, work.slide2 + i);
  // 1/R_e = Q_e/U^2, 1/R_s = Q_s/U^2.
  store(logarithm<kDigits>(curvature_along_entrainment(mean_x2, mean_y2, curvature_x, curvature_y)),
        work.log_along + i);
  store(
      logarithm<kDigits>(curvature_across_entrainment(mean_x2, mean_y2, curvature_x, curvature_y)),
      work.log_across + i);
  store(logarithm<kDigits>(speed2), work.log_speed2 + i);
  store(logarithm<kDigits>(load_all), work.log_load + i);
}

/// The film if it carried all the load.
template <Digits kDigits>
HWY_INLINE void eval_film_under_all(const Tables& t, const ContactBlockInputs& in, Work& work,
                                    int i) {
  const Pack log_along = load(work.log_along + i), log_load = load(work.log_load + i);
  const Pack log_speed2 = load(work.log_speed2 + i);
  const Pack log_thickness = log_film(t.log_film, log_speed2, log_along - log_speed2, log_load);
  const Mask in_range = (load(work.in_range + i) > 0) & within(log_thickness, -70, 7);
  const Pack film =
      exponential<kDigits>(log_thickness) * side_leakage(log_along - load(work.log_across + i));
  store(as_number(in_range), work.in_range + i);
  store(film, work.film_under_all + i);
  const Pack per_root = exponential<kDigits>((-1.0 / 3) * log_load);
  store(load_any(in.load + i) * square(per_root), work.load_root + i);
  store(t.asperity_load_factor * load_any(in.unit_area + i) * per_root, work.asperities + i);
}

/// The same where shear heats the inlet.
template <Digits kDigits>
HWY_INLINE void heat_inlet(const Tables& t, const ContactBlockInputs& in, Work& work, int i) {
  const Pack pressure = load_any(in.unit_pressure + i) * load(work.load_root + i);
  const Pack factor =
      inlet_heating_factor(t.log_thermal_loading, load(work.log_speed2 + i),
                           logarithm<kDigits>(load(work.slide2 + i)), pressure, t.reduced_modulus);
  store(load(work.film_under_all + i) * factor, work.film_under_all + i);
}

/// P(x) = E(x^2) + x O(x^2), so that the chains of Horner's scheme are half as long.
HWY_INLINE WithSlope<Pack> polynomial_and_slope(const std::array<double, kAsperityTerms>& c,
                                                Pack x) {
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

template <std::size_t kTerms>
HWY_INLINE Pack polynomial(const std::array<double, kTerms>& c, Pack x) {
  static_assert(kTerms % 2 == 0);
  const Pack x2 = x * x;
  Pack even = c[1], odd = c[0];
  for (std::size_t j = 2; j < kTerms; j += 2) {
    odd = fused(odd, x2, c[j]);
    even = fused(even, x2, c[j + 1]);
  }
  return fused(odd, x, even);
}

/// The last change of ln(W_EHL/W), which is carried on to second order.
template <Digits kDigits>
constexpr double kShareSettled = kDigits == Digits::kFull ? 2e-6 : 2e-4;

/// One Newton step for ln(e^r + W_asp(r)/W) = 0, r = ln(W_EHL/W) (see load_sharing.h). Returns
/// false if no contact of the pack needs another step; the last changes are then still to be added.
template <Digits kDigits, bool kFirst>
HWY_INLINE bool newton_step_of_share(const Tables& t, Work& work, int i) {
  const Pack ratio_all = load(work.film_under_all + i) * t.inverse_roughness;
  Pack r = 0, third = 1, thinner = 1;
  if (!kFirst) {
    r = load(work.log_share + i);
    third = exponential<kDigits>((1.0 / 3) * r);
    thinner = film_thinning(r);
  }
  const Pack film_ratio = least(ratio_all * thinner, kAsperityEnd);
  const Pack v = 1 / (film_ratio + kAsperityShift);
  const WithSlope<Pack> p =
      polynomial_and_slope(t.f5_2, fused(v, t.asperity_scale, t.asperity_offset));
  const Pack gaussian = exponential<kDigits>(-0.5 * square(film_ratio));
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
  const Mask pending = (load(work.in_range + i) > 0) & (ratio_all < kAsperitiesVanish) &
                       ~(size(change) <= kShareSettled<kDigits>);
  // The others stay, so that the last round serves all of the pack.
  store(select(pending, next, r), work.log_share + i);
  return any(pending);
}

template <Digits kDigits>
HWY_NOINLINE void share_loads(const Tables& t, ActiveLanes active, Work& work) {
  active.keep([&](int i) HWY_ATTR { return newton_step_of_share<kDigits, true>(t, work, i); });
  constexpr int kMostSteps = 8;
  for (int n = 1; n < kMostSteps && !active.empty(); ++n) {
    active.keep([&](int i) HWY_ATTR { return newton_step_of_share<kDigits, false>(t, work, i); });
  }
}

/// The contact as it shares its load by eq 41: film, ellipse and asperities.
template <Digits kDigits>
HWY_INLINE void finish_load_sharing(const Tables& t, const ContactBlockInputs& in,
                                    ContactBlockResults& block, Work& work, int i) {
  const Pack film_under_all = load(work.film_under_all + i);
  const Mask alone = film_under_all * t.inverse_roughness >= kAsperitiesVanish;
  Pack change = load(work.last_change + i);
  const Pack film_ratio = load(work.film_ratio + i);
  // Settled, and not beyond the tabulated film ratios unless the asperities have vanished.
  const Mask in_range =
      (load(work.in_range + i) > 0) &
      (alone | ((film_ratio < kAsperityEnd) & (size(change) <= kShareSettled<kDigits>)));
  store(as_number(in_range), work.in_range + i);

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
  store(asperity_area, work.asperity_area + i);
  store(viscous_area(contact_area, asperity_area), work.viscous_area + i);
  store(square(third) * third * load_any(in.load + i), block.ellipse_load + i);
  store(asperity_load, block.asperity_load + i);
  store(film, block.film_thickness + i);
  store(film * t.inverse_roughness, block.film_ratio + i);
  store(load_any(in.unit_pressure + i) * load_root, block.maximum_pressure + i);
}

/// Where films are too thin to support their load, asperities carry the rest (see shared_contact).
template <Digits kDigits>
HWY_INLINE void close_load_sharing(const Tables& t, const ContactBlockInputs& in,
                                   ContactBlockResults& block, Work& work, int i) {
  const Pack supported = supported_share(load(block.film_ratio + i));
  const Mask closes = supported < 1;
  if (!any(closes)) return;
  const Pack contact_area = load(work.contact_area + i);
  const Pack rest = less_product(supported, load(block.ellipse_load + i), load_any(in.load + i));
  const Pack log_f5_2 = logarithm<kDigits>(rest / (t.asperity_load_factor * contact_area));
  const Pack x = fused(log_f5_2, t.deep_scale, t.deep_offset);
  const Pack f2 = exponential<kDigits>(polynomial(t.deep_area, clamped(x, -1, 1)));
  const Pack area = least(t.asperity_area_factor * contact_area * f2, contact_area);
  const auto replace = [&](Pack value, double* to)
                           HWY_ATTR { store(select(closes, value, load(to)), to); };
  replace(rest, block.asperity_load + i);
  replace(area, work.asperity_area + i);
  replace(supported * viscous_area(contact_area, area), work.viscous_area + i);
  store(as_number((load(work.in_range + i) > 0) & (~closes | (x <= 1))), work.in_range + i);
}

HWY_INLINE void rub_asperities(const Tables& t, ContactBlockResults& block, const Work& work,
                               int i) {
  store(boundary_friction(t.boundary.tribofilm_shear_strength, load(work.asperity_area + i),
                          t.boundary.asperity_friction_coefficient, load(block.asperity_load + i)),
        block.boundary_friction + i);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_CONTACT_SHARE_BLOCK_INL_H_
