// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/integrate/step_sensitivity.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/driveline/motion-inl.h"
#include "core/numerics/dispatch.h"
#include "core/numerics/row-inl.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include "core/integrate/runge_kutta.h"
#include "core/integrate/step_sensitivity.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
void advance_in_rows(const MotionConstants& constants, const TorqueSlopes& by_torque,
                     const std::array<MotionSlopes, 4>& stages, double h,
                     Sensitivity& sensitivity) {
  using States = Row<kMotionStates>;
  constexpr double kTorque[kMotionStates] = {0, 0, 0, 0, 0, 0, 0, 1};  // the last column
  const States torque = load_row<kMotionStates>(kTorque);
  States start[kMotionStates], sum[kMotionStates], s[kMotionStates], ds[kMotionStates];
  for (int i = 0; i < kMotionStates; ++i) {
    start[i] = sum[i] = s[i] = load_row<kMotionStates>(sensitivity[i].data());
  }
  for (int n = 0; n < 4; ++n) {
    for (int i = 0; i < kMotionStates && n > 0; ++i) {
      s[i] = fused(kRungeKuttaNode[n] * h, ds[i], start[i]);
    }
    linear_motion(constants, stages[n], s, ds);
    ds[kPinionShaftSpeed] = fused(by_torque.pinion_shaft, torque, ds[kPinionShaftSpeed]);
    ds[kWheelSpeed] = fused(by_torque.wheel, torque, ds[kWheelSpeed]);
    by_phase(stages[n], s, ds);
    for (int i = 0; i < kMotionStates; ++i) sum[i] = fused(kRungeKuttaWeight[n] * h, ds[i], sum[i]);
  }
  for (int i = 0; i < kMotionStates; ++i) store_row(sum[i], sensitivity[i].data());
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {

void advance_sensitivity(InstructionSet instruction_set, const MotionConstants& constants,
                         const TorqueSlopes& by_torque, const std::array<MotionSlopes, 4>& stages,
                         double length, Sensitivity& sensitivity) {
  TRIBODYN_RETURN_WITH(instruction_set, advance_in_rows, constants, by_torque, stages, length,
                       sensitivity)
}

}  // namespace tribodyn
#endif
