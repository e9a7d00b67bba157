#pragma once

#include "core/dynamics/multiple_shooting.h"
#include "core/dynamics/orbit_friction.h"
#include "core/dynamics/periodic_orbit.h"

namespace tribodyn {

/// Solves for the periodic responses of one system. Keeps what it needs for that from one to the
/// next.
class OrbitSolver {
 public:
  /// Keeps the references; adds to `statistics` and `marched_cycles`. `coefficient`: of Coulomb's
  /// friction in place of the contacts'.
  OrbitSolver(GearPairSystem& system, const FlankContactBatch& contacts,
              MarchStatistics& statistics, long& marched_cycles,
              std::optional<double> coefficient = std::nullopt);

  /// The periodic response without friction, to a permille: where every lubricant's response is
  /// near, and the same for all. With request.renew_friction it is this lubricant's: the periods
  /// marched first have friction, evaluated anew now and then, and the response that of the last
  /// of them. Starts from `orbit` (state, torques) and leaves state, torques, map and pieces there,
  /// and friction if there is any. False where it does not converge.
  bool approach_without_friction(const MeshGrid& grid, const OrbitRequest& request,
                                 PeriodicOrbit& orbit);

  /// For a start that is near to a response, and may be nearer than the response without friction:
  /// one period marched without. Leaves its end and its pieces in `orbit`. False where it breaks
  /// down.
  bool approach_from_near(const MeshGrid& grid, const OrbitRequest& request, PeriodicOrbit& orbit);

  /// The periodic response of the whole system with the unknown torque, without marching through
  /// transients: Newton's method (SingleShooting, MultipleShooting) under lagged friction, friction
  /// evaluated anew on the response found, and so on until neither moves. Derivatives are kept
  /// while they serve. An orbit found before, on another grid, lends its friction and figures: then
  /// one sweep may do. At the end friction and motion belong to each other as in the full system;
  /// what is left is the error of the grid's steps. Starts from `orbit` (state, torques, friction,
  /// map) and leaves the response there. False where it does not converge; the orbit is then of no
  /// use. Where flanks kept together clearly pull, it may end before it converges.
  bool solve(const MeshGrid& grid, const OrbitRequest& request, PeriodicOrbit& orbit);

  /// The map at the response itself, within 1e-4 of the scales, in place of one from farther:
  /// multipliers by it are good to 3e-3 also where contact is lost or periods double. False where
  /// the march breaks down.
  bool renew_map(const MeshGrid& grid, const OrbitRequest& request, PeriodicOrbit& orbit);

 private:
  GearPairSystem& system_;
  OrbitFriction friction_;
  CycleStorage storage_;
  MarchStatistics& statistics_;
  long& marched_cycles_;
};

}  // namespace tribodyn
