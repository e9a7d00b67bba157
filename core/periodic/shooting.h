#pragma once

#include <cmath>

#include "core/integrate/mesh_cycle_march.h"
#include "core/periodic/periodic_orbit.h"
#include "core/periodic/periodic_problem.h"

namespace tribodyn {

/// Newton's method for a periodic orbit under frozen friction: what its two forms share, over one
/// period (SingleShooting) or over all its steps (MultipleShooting).
///  1. A form takes one Newton step and estimates the scaled distance to the orbit.
///  2. Below the tolerance the orbit is found. Otherwise the Jacobian serves again while the
///     distance falls below a fifth of the one before (simplified Newton); else a new one is
///     computed.
///  3. The search fails after a number of steps or of Jacobians, more of them while the distance
///     shrinks, as it does slowly near a flip bifurcation; or if the integration breaks down.
///  4. evaluate_friction() evaluates the contacts on the orbit and freezes their friction anew.
/// (P. Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 2.1; C. T. Kelley, Solving
/// Nonlinear Equations with Newton's Method, 2003, for Jacobians that are kept.)
class Shooting {
 public:
  Shooting(const Shooting&) = delete;
  Shooting& operator=(const Shooting&) = delete;
  virtual ~Shooting() = default;

  /// Simplified Newton: keeps the Jacobian, also one from elsewhere, while a step is shorter than a
  /// fifth of the one before. Returns true once a step is shorter than `tolerance`, scaled.
  bool solve(double tolerance);
  enum class Nodes { kAll, kStarts };
  /// Evaluates friction and figures on the orbit as it is; with kStarts only at the starts of
  /// steps, if no flank is in tension. Returns false if a contact is refused.
  bool evaluate_friction(Nodes nodes = Nodes::kAll);
  /// Writes the orbit and adds to the work.
  virtual void finish(SolverWork& work) = 0;

 protected:
  static constexpr int kUnknowns = PoincareMapJacobian::kUnknowns;
  /// The floor of the scales, 0.1 N m, is five times this force [N].
  static constexpr double kLightForce = 1;

  /// Keeps the references.
  Shooting(const PeriodicProblem& problem, OrbitFriction& friction, const MeshGrid& grid,
           const ShootingOptions& options, PeriodicOrbit& orbit);

  /// One Newton step, with the Jacobian at hand if there is one. Returns an estimate of the scaled
  /// distance to the orbit, at most the length of the step; NaN if the integration breaks down.
  virtual double newton_step() = 0;

  /// Evaluates friction, all figures but the torque, and contact loss.
  virtual bool evaluate(Nodes nodes) = 0;

  void throw_if_interrupted() const;
  double& unknown_torque() { return problem_.unknown(orbit_.torques); }

  const PeriodicProblem& problem_;
  const GearPairSystem& system_;
  OrbitFriction& friction_;
  const MeshGrid& grid_;
  const ShootingOptions& options_;
  PeriodicOrbit& orbit_;
  MarchScales scales_;
  double mean_force_, period_time_;
  /// Load below which the friction arms are held constant [N]: 1e-3 of the force of the torque
  /// itself, because the scales have a floor.
  double light_load_;
  PoincareMapJacobian::Vector scale_;
  FrozenFriction friction_before_;
};

}  // namespace tribodyn
