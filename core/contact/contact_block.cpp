// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/contact_block.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/contact/heat_block-inl.h"
#include "core/contact/share_block-inl.h"
#include "core/numerics/dispatch.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include "core/contact/contact_block.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

/// Proofs, and what follows from the stress.
template <PressureGrowth Growth, Digits kDigits>
HWY_INLINE void certify(const Tables& t, ContactBlockResults& block, const Work& work, int i) {
  const Pack base = load(work.base + i), rise = load(work.rise + i);
  const Pack change = load(work.change + i), scaled = load(work.scaled_pressure + i);
  const Pack factor = load(work.factor + i);
  const Pack next_rise = rise * fused(change, fused(change, 0.5, 1), 1);
  const Pack temperature = base + next_rise;
  Mask certified = (load(work.in_range + i) > 0) & ~(load(work.pending + i) > 0);
  // Inside the table.
  certified = certified & (size(fused(t.factor_scale, factor, t.factor_offset)) <= 1) &
              (factor > 0.01) & (temperature <= t.maximum_temperature);
  const Mask whole = scaled < t.maximum_scaled_pressure;
  Pack share = 0, centre = 0;
  if (t.limited) {
    // One place at most where stress and limit meet behind a limited rim, and not within rounding
    // of none; the last change of T must not make or undo it. (The slope at the cut is that at the
    // end where it counts: near one another.)
    const Pack excess_end = excess_at_end<Growth>(t, work, i);
    const Pack excess_edge = load(work.law_base + i) - t.log_limit_at_edge;
    const Mask clipped = excess_end > 0, all_limited = load(work.all_limited + i) > 0;
    constexpr double kRounding = kDigits == Digits::kFull ? 1e-8 : 1e-6;
    const Pack excess_then = fused(load(work.log_slope + i), next_rise - rise, excess_end);
    certified = certified & (size(excess_edge) > kRounding) & (size(excess_end) > kRounding) &
                (excess_end * excess_then > 0);
    certified = certified & (factor >= t.convex_factor);
    const Mask touched = clipped | all_limited;
    const Pack end = load(work.end + i), cut_change = load(work.cut_change + i);
    const Pack cut = load(work.cut + i) + cut_change;
    const Pack q = fused(load(work.e_cut + i), fused(cut_change, fused(cut_change, 0.5, 1), 1), -1);
    const Pack per_scaled = load(work.per_scaled + i), part = least(q * per_scaled, 1);
    Pack rim = 0;
    if (has_limited_rim(t, work, i)) {
      const Pack x = load(work.rim + i) + load(work.rim_change + i);
      rim = where((excess_edge > 0) & ~all_limited, least(x * per_scaled, 1));
    }
    const Mask inside = (cut > 1e-2) & (cut <= end) & (rim < part);
    certified = certified & (whole | touched) & (inside | all_limited | ~clipped);
    share = select(all_limited, 1, fused(rim, rim, where(clipped, (1 - part) * (1 + part))));
    centre = as_number(touched);
    // One equilibrium: the rise cannot leave the temperatures for which that is proved.
    const Pack most = fused(load(work.gain + i), load(work.all_limit + i), base);
    certified = certified & (most <= t.unique_root_temperature);
  } else {
    certified = certified & whole;
  }
  const Pack stress = t.isothermal ? load(work.mean + i) : next_rise / load(work.gain + i);
  const Pack viscous = viscous_friction(load(work.viscous_area + i), stress);
  const Pack total = friction(viscous, load(block.boundary_friction + i));
  certified = certified & (total < 1e200);  // also false for NaN
  store(viscous, block.viscous_friction + i);
  store(total, block.friction + i);
  store(temperature, block.contact_temperature + i);
  store(stress, block.mean_shear_stress + i);
  store(share, block.limited_area_share + i);
  store(centre, block.limited_at_centre + i);
  store(as_number(certified), block.certified + i);
}

template <PressureGrowth Growth, Digits kDigits>
void solve_with(const Tables& tables, int count, const ContactBlockInputs& in,
                ContactBlockResults& block) {
  Work work;
  const ActiveLanes active(count);
  for (const int i : active) eval_logarithms<kDigits>(in, work, i);
  for (const int i : active) eval_film_under_all<kDigits>(tables, in, work, i);
  if (tables.inlet_shear_heating) {
    for (const int i : active) heat_inlet<kDigits>(tables, in, work, i);
  }
  share_loads<kDigits>(tables, active, work);
  for (const int i : active) finish_load_sharing<kDigits>(tables, in, block, work, i);
  if (tables.closed_load_sharing) {
    for (const int i : active) close_load_sharing<kDigits>(tables, in, block, work, i);
  }
  for (const int i : active) rub_asperities(tables, block, work, i);
  for (const int i : active) eval_thermal_network(tables, in, block, work, i);
  for (const int i : active) {
    prepare_shear<Growth, kDigits>(tables, load(block.sliding_speed + i),
                                   load(block.film_thickness + i), load(block.maximum_pressure + i),
                                   block.shear_rate, work, i);
  }
  solve_coarse<Growth, kDigits == Digits::kHalf>(tables, active, work);
  if (kDigits == Digits::kFull) solve_fine<Growth>(tables, active, work);
  for (const int i : active) certify<Growth, kDigits>(tables, block, work, i);
}

template <PressureGrowth Growth>
void sample_with(const Tables& tables, const StartSamples& in, double* rise) {
  Work work;
  alignas(64) ContactLanes ignored;
  const ActiveLanes active(kBlockContacts);
  for (const int i : active) {
    store(1, work.in_range + i);
    store(tables.inlet_temperature, work.base + i);
    store(0, work.start + i);
    store(load(in.gain + i), work.gain + i);
    prepare_shear<Growth, Digits::kHalf>(tables, load(in.shear_rate + i), 1, load(in.pressure + i),
                                         ignored, work, i);
  }
  solve_coarse<Growth, false>(tables, active, work);
  for (const int i : active) store(load(work.rise + i), rise + i);
}

bool is_roelands(const Tables& tables) {
  return tables.shear.lubricant.pressure_viscosity_law == PressureViscosityLaw::kRoelands;
}

template <PressureGrowth Growth>
void solve_with(const Tables& tables, Digits digits, int count, const ContactBlockInputs& in,
                ContactBlockResults& block) {
  if (digits == Digits::kFull) {
    solve_with<Growth, Digits::kFull>(tables, count, in, block);
  } else {
    solve_with<Growth, Digits::kHalf>(tables, count, in, block);
  }
}

}  // namespace

void solve_block(const Tables& tables, Digits digits, int count, const ContactBlockInputs& in,
                 ContactBlockResults& block) {
  if (is_roelands(tables)) {
    solve_with<RoelandsGrowth>(tables, digits, count, in, block);
  } else {
    solve_with<LawGrowth>(tables, digits, count, in, block);
  }
}

void sample_rises(const Tables& tables, const StartSamples& in, double* rise) {
  if (is_roelands(tables)) {
    sample_with<RoelandsGrowth>(tables, in, rise);
  } else {
    sample_with<LawGrowth>(tables, in, rise);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {

void solve_contact_block(InstructionSet instruction_set, const ContactBlockTables& tables,
                         Digits digits, int count, const ContactBlockInputs& in,
                         ContactBlockResults& out) {
  TRIBODYN_RETURN_WITH(instruction_set, solve_block, tables, digits, count, in, out)
}

void sample_rises(InstructionSet instruction_set, const ContactBlockTables& tables,
                  const StartSamples& samples, double* rise) {
  TRIBODYN_RETURN_WITH(instruction_set, sample_rises, tables, samples, rise)
}

}  // namespace tribodyn
#endif
