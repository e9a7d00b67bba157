#pragma once

#include "core/dynamics/fixed_step_march.h"
#include "core/dynamics/shooting.h"

namespace tribodyn {

/// Newton's method on the section state: a period is marched, through contact loss too, with its
/// variational equations.
class SingleShooting final : public Shooting {
 public:
  /// As Shooting.
  SingleShooting(GearPairSystem& system, OrbitFriction& friction, const MeshGrid& grid,
                 const OrbitRequest& request, PeriodicOrbit& orbit);

  /// Marches on, with the torque that the train's momentum asks for and the mean speed put back.
  bool let_run(int cycles);
  /// Derivatives at the state as it is. Leaves state and pieces. False where the march breaks down.
  bool renew_map();
  void finish(MarchStatistics& statistics, long& marched_cycles) override;

 private:
  /// The pieces are those before the step.
  double improve() override;
  bool evaluate(Places places) override;
  bool march(MarchState& state, Sensitivity* sensitivity);
  void start_regime(const MarchState& state);

  FixedStepMarch march_;
};

}  // namespace tribodyn
