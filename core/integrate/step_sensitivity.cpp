// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/integrate/step_sensitivity.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/numerics/dispatch.h"
#include "core/numerics/row-inl.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include "core/driveline/gear_pair_system.h"
#include "core/integrate/step_sensitivity.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

constexpr int kStates = 8;  // time and the seven of the section
constexpr int kTorque = 7;  // column of the unknown torque
using States = Row<kStates>;

HWY_INLINE void sensitivity_rates(const SensitivityConstants& c, const SensitivityStage& at,
                                  const States& by_torque, const States* s, States* ds) {
  const States velocity =
      fused(at.relative_radius, s[kPinionSpeed], -at.gear_radius * s[kGearSpeed]);
  const States force = fused(at.damping, velocity, at.stiffness * s[kMeshApproach]);
  const States pinion_twisting = s[kPinionShaftSpeed] - s[kPinionSpeed];
  const States gear_twisting = s[kGearSpeed] - s[kWheelSpeed];
  const States pinion_shaft = fused(c.pinion_shaft_stiffness, s[kPinionShaftTwist],
                                    c.pinion_shaft_damping * pinion_twisting);
  const States gear_shaft =
      fused(c.gear_shaft_stiffness, s[kGearShaftTwist], c.gear_shaft_damping * gear_twisting);
  const States pinion =
      fused(at.pinion_arm, force, fused(at.torque_per_approach, s[kMeshApproach], pinion_shaft));
  const States gear = fused(at.gear_arm, force, -1.0 * gear_shaft);
  ds[kTime] = States(0);
  ds[kPinionShaftTwist] = pinion_twisting;
  ds[kMeshApproach] = fused(c.pinion_radius, s[kPinionSpeed], -c.gear_radius * s[kGearSpeed]);
  ds[kGearShaftTwist] = gear_twisting;
  ds[kPinionShaftSpeed] =
      fused(-c.per_pinion_shaft_inertia, pinion_shaft, c.pinion_shaft_per_torque * by_torque);
  ds[kPinionSpeed] = c.per_pinion_inertia * pinion;
  ds[kGearSpeed] = c.per_gear_inertia * gear;
  ds[kWheelSpeed] = fused(c.per_wheel_inertia, gear_shaft, c.wheel_per_torque * by_torque);
  // From time to phase.
  const States slower = -at.per_speed * s[kPinionSpeed];
  for (int i = 0; i < kStates; ++i) ds[i] = fused(at.rate[i], slower, at.time * ds[i]);
}

}  // namespace

void advance_in_rows(const SensitivityConstants& constants,
                     const std::array<SensitivityStage, 4>& stages, double h,
                     Sensitivity& sensitivity) {
  constexpr double kNode[4] = {0, 0.5, 0.5, 1}, kWeight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  constexpr double kByTorque[kStates] = {0, 0, 0, 0, 0, 0, 0, 1};
  static_assert(kTorque == kStates - 1);
  const States by_torque = load_row<kStates>(kByTorque);
  States start[kStates], sum[kStates], s[kStates], ds[kStates];
  for (int i = 0; i < kStates; ++i) {
    start[i] = sum[i] = s[i] = load_row<kStates>(sensitivity[i].data());
  }
  for (int n = 0; n < 4; ++n) {
    for (int i = 0; i < kStates && n > 0; ++i) s[i] = fused(kNode[n] * h, ds[i], start[i]);
    sensitivity_rates(constants, stages[n], by_torque, s, ds);
    for (int i = 0; i < kStates; ++i) sum[i] = fused(kWeight[n] * h, ds[i], sum[i]);
  }
  for (int i = 0; i < kStates; ++i) store_row(sum[i], sensitivity[i].data());
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {

void advance_sensitivity(InstructionSet instruction_set, const SensitivityConstants& constants,
                         const std::array<SensitivityStage, 4>& stages, double length,
                         Sensitivity& sensitivity) {
  TRIBODYN_RETURN_WITH(instruction_set, advance_in_rows, constants, stages, length, sensitivity)
}

}  // namespace tribodyn
#endif
