#pragma once

#include <functional>
#include <vector>

#include "core/dynamics/fixed_step_march.h"
#include "core/dynamics/steady_state.h"

namespace tribodyn {

/// What shooting reports of a response: enough to tell how much an answer moved.
struct OrbitFigures {
  double loss_rms = 0;     ///< of sum V_s F_fr / phidot_s [N m]: eq 30 but for T_s
  double loss_energy = 0;  ///< sum V_s F_fr over the period [J]
  double dte_minimum = 0;  ///< x [m]
  double dte_maximum = 0;
  double torque = 0;  ///< the unknown one [N m]
  /// Largest relative difference of any.
  double distance(const OrbitFigures& other) const;
};

/// A piece with everything known at its start, middle and end.
struct SolvedPiece {
  OrbitPiece piece;
  std::array<Instant, 3> at;
};

/// Where shooting begins, and what it has found so far.
struct PeriodicOrbit {
  MarchState state{};    ///< at mesh phase 0
  ContactRegime regime;  ///< there
  Torques torques;
  int period = 1;  ///< [mesh cycles]
  LaggedFriction friction;
  std::vector<SolvedPiece> pieces;
  OrbitFigures figures;
  double defect = 0;              ///< scaled change of the state in the last step of Newton
  double unsettled = 0;           ///< estimate of what further sweeps would still change, relative
  double largest_multiplier = 0;  ///< Floquet, modulus
  bool contact_loss = false;
  bool tension = false;  ///< somewhere the flanks were held together by force
};

struct OrbitRequest {
  double mean_pinion_speed = 0;     ///< held exactly [rad/s]
  bool solve_wheel_torque = false;  ///< T_w is the unknown instead of T_s
  int steps = 48;                   ///< in a mesh cycle
  bool keep_contact = false;  ///< flanks stay together whatever the force: the linear response
  int first_cycles = 0;       ///< marched under lagged friction before shooting
  double tolerance = 1e-6;    ///< of the figures, relative: sweeps go on until then
  std::function<bool()> interrupted;  ///< true: throws Cancelled
};

/// The periodic response of the whole system with the unknown torque, without marching through
/// transients: Newton's method on the section state (single shooting, variational equations) under
/// lagged friction, friction evaluated anew on the response found, and so on until neither moves.
/// At the end friction and motion belong to each other as in the full system; what is left is the
/// error of the steps. Starts from `orbit` (state, torques, friction) and leaves the response
/// there. False where it does not converge; the orbit is then of no use. Adds to `statistics`.
bool solve_periodic_orbit(GearPairSystem& system, const OrbitRequest& request, PeriodicOrbit& orbit,
                          MarchStatistics& statistics, long& marched_cycles);

}  // namespace tribodyn
