#pragma once

#include <optional>

#include "core/driveline/gear_pair_system.h"
#include "core/integrate/mesh_grid.h"

namespace tribodyn {

/// A state at mesh phase 0 near the orbit of flanks that tap each other once in a mesh cycle, under
/// a load so light that they cannot follow the transmission error:
///  1. The gears float in the middle of the backlash under no torque. Newton's method finds the
///     cycle that repeats; as the Jacobian leaves two freedoms open (mesh approach and speed), the
///     shortest of its corrections is taken, by a complete orthogonal decomposition.
///  2. The mesh approach is moved until the mesh stiffness times the overlap of the flanks carries
///     the pinion torque in the mean over a mesh cycle: a convex function of the shift, whose root
///     Newton's method approaches from above.
///  3. Both are repeated from close to the flanks, because R_g's ripple lies elsewhere there;
///     shafts are wound up by the torques.
/// (Newton's method with the pseudoinverse: A. Ben-Israel, J. Math. Anal. Appl. 15, 1966, 243.)
///
/// Returns nullopt if that load holds the flanks together at all phases, if there is no pinion
/// torque, or if the gears do not float: too little backlash.
std::optional<MarchState> tapping_start(const GearPairSystem& system, const Torques& torques,
                                        const MeshGrid& grid, double mean_pinion_speed);

/// Whether a load is so light that the flanks tap each other: they cannot follow the transmission
/// error, as the mesh is at its stiffest softer than that swing by that load. True without a load.
bool flanks_tap(const MeshData& mesh, double pinion_torque);

/// The state at mesh phase 0 of gears that float in the middle of the backlash under no torque.
/// Returns nullopt if they do not float: too little backlash.
std::optional<MarchState> floating_start(const GearPairSystem& system, const MeshGrid& grid,
                                         double mean_pinion_speed);

}  // namespace tribodyn
