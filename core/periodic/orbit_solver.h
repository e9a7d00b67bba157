#pragma once

#include "core/periodic/multiple_shooting.h"
#include "core/periodic/orbit_friction.h"
#include "core/periodic/periodic_orbit.h"

namespace tribodyn {

// Periodic orbits by shooting under frozen friction, without integration through transients:
//  1. An orbit without friction to 1e-3 of the scales, or one integrated period, is the start.
//  2. Newton's method on the section state and the unknown torque solves for the orbit under the
//     friction at hand. The Jacobian is kept while a step leaves less than a fifth of the one
//     before (simplified Newton). Without a gap all steps of a mesh cycle are unknowns
//     (MultipleShooting), otherwise the state at the section alone (SingleShooting).
//  3. Friction is evaluated on the orbit and frozen again (Picard). The gain of the figures over
//     the friction, measured by a secant, gives the change by further iterations.
//  4. Steps 2 and 3 repeat until neither changes the figures by more than the tolerance. The error
//     that remains is that of the grid's steps.
// (R. Seydel, Practical Bifurcation and Stability Analysis, 3rd ed., 2010, chapter 7; for the
// simplified Newton method P. Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 2.1.)

/// Solves for periodic orbits of one problem. Keeps its storage from one orbit to the next.
class OrbitSolver {
 public:
  /// Keeps the references; adds to `work`. With a `coefficient` friction is Coulomb's in place of
  /// the contacts'.
  OrbitSolver(const PeriodicProblem& problem, SolverWork& work,
              std::optional<double> coefficient = std::nullopt);

  /// Solves for the frictionless orbit to 1e-3: near the orbit of every lubricant, and independent
  /// of the lubricant unless options.renew_friction gives the periods integrated first friction.
  /// Starts from `orbit` (state, torques) and leaves state, torques, Jacobian and pieces there, and
  /// friction if there is any. Returns false if it does not converge.
  bool solve_without_friction(const MeshGrid& grid, const ShootingOptions& options,
                              PeriodicOrbit& orbit);

  /// Integrates one period without friction: for a start that may be nearer to an orbit than the
  /// frictionless orbit is. Leaves its end and its pieces in `orbit`. Returns false if it breaks
  /// down.
  bool march_one_period(const MeshGrid& grid, const ShootingOptions& options, PeriodicOrbit& orbit);

  /// Solves for the orbit from `orbit` (state, torques, friction, Jacobian) and leaves it there. An
  /// orbit from another grid keeps its friction and figures: one Picard iteration may then be
  /// enough. Returns false if it does not converge; `orbit` is then of no use. Ends before it
  /// converges if bilateral contact surely hides contact loss.
  bool solve(const MeshGrid& grid, const ShootingOptions& options, PeriodicOrbit& orbit);

  /// Computes the Jacobian at the orbit itself (within 1e-4 of the scales), in place of one from
  /// farther: multipliers by it are good to 3e-3 also with contact loss or near a period doubling.
  /// Returns false if the integration breaks down.
  bool renew_jacobian(const MeshGrid& grid, const ShootingOptions& options, PeriodicOrbit& orbit);

 private:
  const PeriodicProblem& problem_;
  OrbitFriction friction_;
  CycleStorage storage_;
  SolverWork& work_;
};

}  // namespace tribodyn
