#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>

#include "core/periodic/periodic_orbit.h"
#include "core/periodic/periodic_problem.h"

namespace tribodyn {

// The quasi-static model: constant speeds, xdot = 0, and at each mesh phase the load at which the
// pinion is in equilibrium, R_p F = T_s + T_fr,p(F).
//  1. Under friction arms (torque over load) that are held, the equilibria at the nodes of a grid
//     follow in closed form, but for the mesh approach, on which R_g depends: four substitutions.
//  2. The contacts of the whole mesh cycle are solved together on them; they give new arms, and by
//     the mean power the unknown torque.
//  3. Steps 1 and 2 repeat (Picard; each repetition divides the error by some thirty). The ratio c
//     of the last two changes of the figures estimates the change that is left: c/(1 - c) times the
//     last one.
//  4. Grids are refined until Richardson's estimate is within the tolerance (grid_convergence.h).
//  5. What the model leaves out is estimated by the linear response to inertia and dampers
//     (linear_response.h). (C. T. Kelley, Iterative Methods for Linear and Nonlinear Equations,
//     1995, chapter 4, for fixed-point iterations.)

/// The orbit's pieces hold the equilibria; it has no map. Two grids or more, until the estimate is
/// within the tolerance or steps are finest. Returns nullopt if a contact is refused (the tally has
/// the reason) or the iteration does not converge.
std::optional<PeriodicOrbit> solve_quasi_static(const PeriodicProblem& problem);

/// The static equilibrium at a mesh phase [cycles] and a pinion speed [rad/s] under torques and
/// friction in proportion to the load, on the flanks of a side.
MarchState static_equilibrium(const GearPairSystem& system, const Torques& torques, int side,
                              const MeshPhase& at, double phase, const FrictionArms& friction,
                              double speed);

/// The relative distance of the quasi-static figures from those of the full model, as
/// PointResult::estimated_relative_error means it. Inertia and dampers are added to first order
/// (inertial_correction), the contacts solved once more on the corrected motion, and the figures
/// compared; the ripple of the mesh stiffness, harmonics beyond the grid and a margin come on top.
/// Infinite where the estimate is void: flanks may part, the mesh may resonate, or the ripple of
/// the stiffness may sustain a vibration.
double quasi_static_model_error(const PeriodicProblem& problem, const PeriodicOrbit& solution);

/// Returns false if the mechanics alone, before any friction is computed, put the model's error
/// beyond the tolerance: the correction of three harmonics, then of all harmonics of the grid,
/// against the tolerance. Takes two microseconds if three harmonics decide, eight otherwise.
bool passes_quasi_static_screen(const PeriodicProblem& problem);

/// A bounded cache of passes_quasi_static_screen(), which does not depend on the lubricant. Of one
/// gear set and its options; one thread at a time.
class QuasiStaticScreen {
 public:
  bool passes(const PeriodicProblem& problem);

 private:
  static constexpr std::size_t kMostKept = 500;
  /// Speed, torques, tolerance and which torque is unknown.
  std::map<std::array<double, 5>, bool> known_;
};

}  // namespace tribodyn
