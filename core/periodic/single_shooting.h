#pragma once

#include "core/integrate/rk4_with_events.h"
#include "core/periodic/shooting.h"

namespace tribodyn {

/// Newton's method on the state at mesh phase 0 and the unknown torque. A period is integrated with
/// its variational equations, through contact loss too.
class SingleShooting final : public Shooting {
 public:
  /// As Shooting.
  SingleShooting(const PeriodicProblem& problem, OrbitFriction& friction, const MeshGrid& grid,
                 const ShootingOptions& options, PeriodicOrbit& orbit);

  /// Integrates periods; after each the unknown torque takes up the momentum gained, and the mean
  /// speed is restored (correct_period).
  bool march_transient(int cycles);
  /// Computes the Jacobian at the state as it is. Leaves state and pieces. Returns false if the
  /// integration breaks down.
  bool renew_jacobian();
  void finish(SolverWork& work) override;

 private:
  /// Leaves the pieces of the orbit before the step.
  double newton_step() override;
  bool evaluate(Nodes nodes) override;
  bool march(MarchState& state, Sensitivity* sensitivity);

  Rk4WithEvents march_;
};

}  // namespace tribodyn
