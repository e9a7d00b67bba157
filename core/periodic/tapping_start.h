#pragma once

#include <optional>

#include "core/driveline/gear_pair_system.h"
#include "core/integrate/mesh_grid.h"

namespace tribodyn {

/// Under a load so light that the flanks cannot follow the transmission error they float in the
/// backlash and tap each other once in a mesh cycle. The state at mesh phase 0 of such a response,
/// nearly: how the gears float is marched under no torque, in the middle of the backlash, until the
/// damper has settled it; then they are brought so near that the mesh stiffness times the overlap
/// of the flanks carries the system's pinion torque in the mean over a mesh cycle.
///
/// Returns nullopt if that load holds the flanks together at all phases, if there is no pinion
/// torque, or if the gears do not float: too little backlash. Leaves the system's torques; its
/// regime changes.
std::optional<MarchState> tapping_start(GearPairSystem& system, const MeshGrid& grid,
                                        double mean_pinion_speed);

/// The state at mesh phase 0 of gears that float in the middle of the backlash under no torque.
/// Returns nullopt if they do not float: too little backlash. Sets the system's torques to zero;
/// its regime changes.
std::optional<MarchState> floating_start(GearPairSystem& system, const MeshGrid& grid,
                                         double mean_pinion_speed);

}  // namespace tribodyn
