#pragma once

#include <optional>

#include "core/integrate/solver_work.h"
#include "core/periodic/coulomb_orbits.h"
#include "core/periodic/periodic_problem.h"

namespace tribodyn {

// The search for an attracting periodic orbit:
//  1. Shooting (orbit_solver.h) on a sequence of grids, until Richardson's estimate of the figures'
//     error and the Picard error are within the tolerance (grid_convergence.h). First under
//     bilateral contact; if that needs tension, from periods integrated with backlash.
//  2. The largest Floquet multiplier decides whether the orbit attracts: by the Jacobian of the
//     Poincare map, and near 1 by that of a map whose friction follows the motion.
//  3. After a flip bifurcation the period is doubled, from beside the orbit that repels; near a
//     fold, or where friction decides the branch, hundreds of periods are integrated first, with
//     friction renewed on the way. An orbit of twice its true period is halved.
// Where all of this finds no orbit that surely attracts, the caller marches until the response
// repeats (steady_state.h). (R. Seydel, Practical Bifurcation and Stability Analysis, 3rd ed.,
// 2010, chapters 6 and 7; R. I. Leine and H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth
// Mechanical Systems, 2004.)

/// From where and how long an orbit is searched for.
struct OrbitSearch {
  MarchState start{};             ///< at mesh phase 0
  int period = 1;                 ///< [mesh cycles]
  bool try_contact_first = true;  ///< the orbit without contact loss, if there is one
  /// Periods integrated from the start before Newton's method, and if it does not converge from
  /// there. Not critical: from 4 to 24 and from 30 to 120 random scenes (core/README.md) come out
  /// the same, for 0.7 % less to 1.1 % more work.
  int few_cycles = 12, first_cycles = 60;
  int maximum_mesh_cycles = 4000;     ///< integrated in search of an orbit
  bool allow_transient_march = true;  ///< further tries, at last after hundreds of periods
  bool renew_friction = false;  ///< during the transient: the attractor may depend on friction
  CoulombOrbits* coulomb_orbits = nullptr;  ///< shared by lubricants, to start from; may be null
};

/// The number of oscillations of the mesh on its mean stiffness in a mesh cycle.
double mesh_oscillations(const GearPairSystem& system, double mean_pinion_speed);

/// Whether find_orbit() has too few steps for so many.
bool oscillates_too_often(double mesh_oscillations);

/// Returns nullopt if shooting does not converge, the orbit repels or may repel, or the tolerance
/// needs more than the largest number of steps. `aperiodic` then holds a point beside an orbit that
/// repels, if all orbits that were found do, also of the longest period: a march from there will
/// not settle either. Adds to `work`.
std::optional<PeriodicOrbit> find_orbit(const PeriodicProblem& problem, const OrbitSearch& search,
                                        SolverWork& work, std::optional<SectionPoint>& aperiodic);

}  // namespace tribodyn
