#pragma once

#include <functional>

#include "core/contact/flank_contact_batch.h"
#include "core/driveline/gear_pair_system.h"
#include "core/integrate/mesh_grid.h"

namespace tribodyn {

/// A periodic response that is searched for.
struct PeriodicProblem {
  const GearPairSystem& system;
  const FlankContactBatch& contacts;
  MeshGrids& grids;
  ContactTally& tally;
  Torques torques;                    ///< the known one, and a first guess of the unknown one
  double mean_pinion_speed = 0;       ///< held exactly [rad/s]
  bool solve_wheel_torque = false;    ///< T_w is the unknown instead of T_s
  double tolerance = 1e-5;            ///< wanted, of the figures, relative
  std::function<bool()> interrupted;  ///< true: throws Cancelled; may be empty

  double& unknown(Torques& all) const { return solve_wheel_torque ? all.wheel : all.pinion; }
};

}  // namespace tribodyn
