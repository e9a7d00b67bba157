#pragma once

#include "core/driveline/gear_pair_system.h"

namespace tribodyn {

/// Corrects the unknown torque and the state after a period: the torque takes up the momentum that
/// the whole train gained, its wind-up goes into mesh and shafts, and the mean speed is restored.
/// `before`: the state at the section a period ago; `after[kTime]`: the duration [s].
void correct_period(const GearPairSystem& system, const MarchState& before, int period,
                    double mean_pinion_speed, bool solve_wheel_torque, Torques& torques,
                    MarchState& after);

}  // namespace tribodyn
