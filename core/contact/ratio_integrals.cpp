// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/ratio_integrals.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/numerics/dispatch.h"
#include "core/numerics/pack-inl.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include "core/contact/ratio_integrals.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
void integrate_in_lanes(const RatioRule& rule, const RatioLanes& factor,
                        std::array<RatioLanes, kRatioPoints>& values) {
  for (int lane = 0; lane < static_cast<int>(factor.size()); lane += pack_lanes()) {
    const Pack l = load_any(factor.data() + lane);
    Pack integral = 0;
    double growth = 0;
    for (int j = 0; j < kRatioPoints; ++j) {
      const RatioInterval& interval = rule[j];
      integral = integral * exponential(l * (growth - interval.growth));
      for (int n = 0; n < RatioInterval::kNodes; ++n) {
        integral = fused(interval.weight[n], exponential(l * interval.less[n]), integral);
      }
      store_any(interval.per_square * integral, values[j].data() + lane);
      growth = interval.growth;
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {

void integrate_ratios(InstructionSet instruction_set, const RatioRule& rule,
                      const RatioLanes& factor, std::array<RatioLanes, kRatioPoints>& values) {
  TRIBODYN_RETURN_WITH(instruction_set, integrate_in_lanes, rule, factor, values)
}

}  // namespace tribodyn
#endif
