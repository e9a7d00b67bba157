#pragma once

#include <functional>

#include "core/contact/flank_contact_batch.h"
#include "core/driveline/gear_pair_system.h"
#include "core/integrate/mesh_grid.h"

namespace tribodyn {

/// A periodic response that is searched for, under the system's torques.
struct PeriodicProblem {
  GearPairSystem& system;
  const FlankContactBatch& contacts;
  MeshGrids& grids;
  double mean_pinion_speed = 0;       ///< held exactly [rad/s]
  bool solve_wheel_torque = false;    ///< T_w is the unknown instead of T_s
  double tolerance = 1e-5;            ///< wanted, of the figures, relative
  std::function<bool()> interrupted;  ///< true: throws Cancelled; may be empty
};

}  // namespace tribodyn
