#pragma once

#include <functional>

#include "core/dynamics/mesh_cycle_march.h"

namespace tribodyn {

/// What a steady state must satisfy, and how much work may go into it.
struct SteadyStateRequest {
  double mean_pinion_speed = 0;     ///< held exactly [rad/s]
  bool solve_wheel_torque = false;  ///< T_w is the unknown instead of T_s
  int first_period =
      1;  ///< tried first [mesh cycles]: that of the response the start is taken from
  MarchOptions march;
  double tolerance = 1e-6;  ///< of the response, see PointOptions::settling_tolerance
  int maximum_mesh_cycles = 4000;
  std::function<bool(double)> progress;  ///< false: throws Cancelled
};

struct SteadyState {
  MarchState state{};    ///< at mesh phase 0
  ContactRegime regime;  ///< there
  Torques torques;
  bool settled = false;
  int period = 0;                 ///< in mesh cycles; 0: none found
  double defect = 0;              ///< scaled change of the state over the last period
  double largest_multiplier = 0;  ///< Floquet, modulus; below 1: attracting. 0 when not settled
  long mesh_cycles = 0;
  long accelerations = 0;
  MarchStatistics statistics;
};

/// Static equilibrium of mesh and shafts at mesh phase 0 and the mean speed, under the system's
/// torques and the given friction torques [N m] (eqs 2, 3): where a single point starts.
/// `offset` [m] is added to the mesh deflection (positive: pressed together).
MarchState static_start(const GearPairSystem& system, double mean_pinion_speed,
                        double pinion_friction_torque, double gear_friction_torque, double offset);

/// Marches mesh cycles until the response repeats. After each period the unknown torque takes up
/// the momentum gained, its wind-up goes into shafts and mesh, and the mean speed is put back. Once
/// the response contracts, Anderson's extrapolation over the last periods (Walker and Ni, SIAM J.
/// Numer. Anal. 49, 2011, 1715) replaces the slow approach of the shaft modes; a step that does not
/// help is taken back, and a repelling orbit (Floquet multiplier above 1) is left again. Periods of
/// 1, 2, 3, 4 mesh cycles are looked for; where none settles within the work limit, `settled` is
/// false.
///
/// Slow and sure: OrbitSolver is tried first.
SteadyState solve_steady_state(GearPairSystem& system, const MarchState& start,
                               const SteadyStateRequest& request);

/// Largest modulus of the Floquet multipliers of a periodic response with friction in the loop,
/// under the system's torques; by marching it once for each state that moves and once more (forward
/// differences): with a relative tolerance of 1e-8 to some 1e-4.
/// `state`: at mesh phase 0; `period` [mesh cycles]. Adds to `statistics` and `mesh_cycles`. Throws
/// as the march does.
double marched_multiplier(GearPairSystem& system, const MarchState& state, int period,
                          const SteadyStateRequest& request, MarchStatistics& statistics,
                          long& mesh_cycles);

}  // namespace tribodyn
