#pragma once

#include <functional>

#include "core/integrate/mesh_cycle_march.h"
#include "core/periodic/periodic_orbit.h"
#include "core/periodic/periodic_problem.h"

namespace tribodyn {

/// How a steady state is marched to, and how much work may go into it. The problem's tolerance is
/// that of the response: see PointOptions::march_settling_tolerance.
struct SteadyStateOptions {
  int first_period = 1;  ///< tried first [mesh cycles]: that of the response of the start
  MarchOptions march;
  int maximum_mesh_cycles = 4000;        ///< without those that measure the multiplier
  std::function<bool()> is_over;         ///< called between periods; true ends the search
  std::function<bool(double)> progress;  ///< false: throws Cancelled
};

/// Half-width of the interval around 1 in which a multiplier by marched differences does not decide
/// whether an orbit attracts. The differences err by 4e-7 in twelve random scenes (core/README.md):
/// a caution for others, as with 1e-5 and 3e-3 the marches of 30 of them come out the same.
inline constexpr double kDoubtOfMarchedMultiplier = 3e-4;

struct SteadyState : SectionPoint {
  bool settled = false;
  int period = 0;                 ///< in mesh cycles; 0: none found
  double defect = 0;              ///< scaled change of the state over the last period
  double largest_multiplier = 0;  ///< Floquet, modulus; below 1: attracting. 0 when not settled
  long accelerations = 0;         ///< accepted extrapolations
  SolverWork work;
};

/// The static equilibrium of mesh and shafts at mesh phase 0 and the mean speed, under torques and
/// friction torques [N m] (eqs 2, 3). `offset` [m] is added to the mesh
/// deflection (positive: pressed together).
MarchState static_start(const GearPairSystem& system, const Torques& torques,
                        double mean_pinion_speed, double pinion_friction_torque,
                        double gear_friction_torque, double offset);

/// Marches mesh cycles with the event-exact integrator until the response repeats:
///  1. After each period the unknown torque takes up the momentum gained, its wind-up goes into
///     shafts and mesh, and the mean speed is restored (correct_period).
///  2. Once the defect contracts, Anderson's extrapolation over the last periods replaces the slow
///     approach of the shaft modes; a step that does not help is taken back. (H. F. Walker and P.
///     Ni, SIAM J. Numer. Anal. 49, 2011, 1715.)
///  3. An orbit that the extrapolation finds is kept if its largest Floquet multiplier, by finite
///     differences, is not above 1; otherwise the march leaves it again.
/// Periods of 1, 2, 3, 4 mesh cycles are tried. If none settles within the limits, `settled` is
/// false, and the point of the section is the last one that was marched to without extrapolation.
/// Slow and robust: find_orbit() is tried first.
SteadyState solve_steady_state(const PeriodicProblem& problem, ContactSolver& contacts,
                               const SectionPoint& start, const SteadyStateOptions& options);

/// The largest modulus of the Floquet multipliers of a periodic orbit with friction in the loop,
/// by one march of the period and one for each state (forward differences): to some 1e-4 at a
/// relative tolerance of 1e-8. Adds to `work`. Throws as the march does.
double marched_multiplier(const PeriodicProblem& problem, const PeriodicOrbit& orbit,
                          const MarchOptions& march, SolverWork& work);

}  // namespace tribodyn
