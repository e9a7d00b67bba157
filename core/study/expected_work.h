#pragma once

#include "core/study/operating_target.h"

namespace tribodyn {

/// Contact solutions that a point of the full model is expected to take, before it is solved.
struct ExpectedWork {
  double shooting = 0;
  double marching = 0;
};

/// Estimates the work from speed, torque, damping and tolerances:
///  1. Shooting takes more steps for a sharper tolerance, and the more often the mesh oscillates in
///     a mesh cycle.
///  2. A march that is requested takes as many mesh cycles as the slowest vibration of the
///  driveline
///     needs to die out (linear_modes.h), but no more than extrapolation does; each has the steps
///     of the mesh tables and those of the oscillations.
///  3. Where the load is so light that flanks tap each other (tapping_start.h), shooting often
///  finds
///     nothing, and the march takes up to its limit of work.
/// On the reference axle the estimate is within a factor of three if the load holds the flanks
/// together: from 1 to 200 km/h, step tolerances from 1e-9 to 1e-5 and shaft damping from a
/// hundredth to tenfold. Where shooting finds no attracting response under such a load, a march
/// takes up to kMostContactsOfAutomaticMarch more.
ExpectedWork expected_work(const GearPairSystem& system, const OperatingTarget& target,
                           const PointOptions& options);

}  // namespace tribodyn
