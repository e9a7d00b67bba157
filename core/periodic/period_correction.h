#pragma once

#include "core/driveline/gear_pair_system.h"

namespace tribodyn {

/// What a marched period tells of the unknown torque: the momentum that the whole train gained must
/// come from it, its wind-up goes into mesh and shafts, and the mean speed is put back.
/// `before`: the state at the section a period ago; `after[kTime]`: how long it took [s].
/// Changes the system's torques.
void correct_period(GearPairSystem& system, const MarchState& before, int period,
                    double mean_pinion_speed, bool solve_wheel_torque, MarchState& after);

}  // namespace tribodyn
