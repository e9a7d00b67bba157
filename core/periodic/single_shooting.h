#pragma once

#include "core/integrate/rk4_with_events.h"
#include "core/periodic/shooting.h"

namespace tribodyn {

/// Newton's method on the state at mesh phase 0 and the unknown torque, eight unknowns:
///  1. A period is integrated under frozen friction by classical Runge-Kutta steps that end at
///     contact loss and regain (Rk4WithEvents), from the state at hand.
///  2. The residual is the change of the seven states over the period, and the time that it took
///     less the one wanted.
///  3. If there is no Jacobian, the variational equations are integrated along; where the rates
///     jump, the saltation matrix takes the sensitivities across (PoincareMapJacobian).
///  4. State and torque take Newton's step; Shooting decides whether the Jacobian serves again.
///  5. The search fails once it is farther from the state that integration reached than flanks can
///     move: twice the backlash and the static deflection. An orbit out there may attract, but not
///     from the start that was asked for.
/// (R. Seydel, Practical Bifurcation and Stability Analysis, 3rd ed., 2010, chapter 7; R. I. Leine
/// and H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004.)
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
  /// Of the state at the section from PeriodicOrbit::marched, in the norm of the scales, as a
  /// length [m].
  double distance_from_marched() const;

  Rk4WithEvents march_;
  double farthest_;  ///< from PeriodicOrbit::marched [m]
};

}  // namespace tribodyn
