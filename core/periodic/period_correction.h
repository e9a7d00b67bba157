#pragma once

#include "core/driveline/gear_pair_system.h"

namespace tribodyn {

/// Returns the torque at the pinion that accelerated the whole train: its gain of momentum since a
/// state at the section, over the duration `after[kTime]` [N m].
double accelerating_torque(const GearPairSystem& system, const MarchState& before,
                           const MarchState& after);

/// Lowers the unknown torque by a torque at the pinion [N m]; its wind-up goes into mesh and
/// shafts.
void lower_torque(const GearPairSystem& system, double by, bool solve_wheel_torque,
                  Torques& torques, MarchState& state);

/// Shifts the speeds of the whole train by what the pinion's mean speed over some mesh cycles,
/// which took `state[kTime]`, was off.
void restore_mean_speed(const GearPairSystem& system, int mesh_cycles, double mean_pinion_speed,
                        MarchState& state);

/// Corrects the unknown torque and the state after a period: the torque takes up the momentum that
/// the whole train gained, and the mean speed is restored.
/// `before`: the state at the section a period ago; `after[kTime]`: the duration [s].
void correct_period(const GearPairSystem& system, const MarchState& before, int period,
                    double mean_pinion_speed, bool solve_wheel_torque, Torques& torques,
                    MarchState& after);

}  // namespace tribodyn
