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
///  2. A requested march takes as many mesh cycles as the slowest vibration needs to die out
///     (linear_modes.h), at most those of the extrapolation. The steps of a mesh cycle resolve the
///     samples of the tables and the oscillations of the mesh.
///  3. Where flanks tap each other under a light load (tapping_start.h), shooting often fails, and
///     the march takes up to its limit of work.
/// On the reference axle the estimate is within a factor of three if the load holds the flanks
/// together: from 1 to 200 km/h, step tolerances from 1e-9 to 1e-5 and shaft damping from a
/// hundredth to tenfold. Where shooting finds no attracting response under such a load, a march
/// takes up to kMostContactsOfAutomaticMarch more.
ExpectedWork expected_work(const GearPairSystem& system, const OperatingTarget& target,
                           const PointOptions& options);

}  // namespace tribodyn
