#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/periodic/orbit_friction.h"
#include "core/periodic/poincare_map_jacobian.h"

namespace tribodyn {

struct CycleDerivatives;

/// A periodic orbit, or the state from which shooting starts for one.
struct PeriodicOrbit {
  MarchState state{};  ///< at mesh phase 0
  /// The state that integration has reached, from where Newton's method started: the orbit that it
  /// finds must be near (SingleShooting).
  std::optional<MarchState> marched;
  Torques torques;
  int period = 1;  ///< [mesh cycles]
  FrozenFriction friction;
  std::optional<PoincareMapJacobian> jacobian;  ///< from here or near; empty: not known
  /// Upper bound of the scaled distance of the state since the Jacobian was computed by
  /// SingleShooting, and the number of pieces then.
  double distance_since_jacobian = std::numeric_limits<double>::infinity();
  std::size_t pieces_of_jacobian = 0;
  /// The Jacobians of all steps, if MultipleShooting has found the orbit.
  std::shared_ptr<const CycleDerivatives> cycle_derivatives;
  std::vector<OrbitPiece> pieces;
  std::shared_ptr<const SolvedContacts> contacts;  ///< of the pieces, once a response is found
  OrbitFigures figures;
  double defect = 0;  ///< length of the last Newton step, or the estimated rest; scaled
  /// Change of the friction by its last evaluation, relative (FrozenFriction::distance).
  double friction_change = 0;
  /// Relative change of the figures per relative change of the friction, by a secant; 0: not
  /// estimated. The figures are nearly proportional to the friction.
  double friction_gain = 0;
  double friction_gain_floor = 0;  ///< lower bound of it, from an orbit nearby
  double picard_error = 0;         ///< estimate of the relative change by further Picard iterations
  int steps_per_mesh_cycle = 0;    ///< of the grid that the pieces are on
  /// Of loss (RMS and energy), torque and extremes of the transmission error, relative: of the
  /// steps and of the Picard iteration.
  double estimated_error = 0;
  /// Floquet, modulus, with friction in the loop; absent where the map alone is clear enough.
  std::optional<double> multiplier_with_friction;
  bool barely_attracts = false;  ///< that multiplier is within its error of 1
  bool contact_loss = false;
  bool is_tapping = false;  ///< found from tapping_start()
  /// Smallest compression of touching flanks over the mean force; negative: tension under bilateral
  /// contact.
  double least_pressing_force = 0;
};

/// Tension over the mean force: flanks that bilateral contact holds together under more than this
/// part without it. Not critical: with 0.005 random scenes (core/README.md) take the same work and
/// one end of a branch moves by 0.04 km/h, with 0.1 they take 0.1 % more.
inline constexpr double kTensionForSeparation = 0.02;

/// How shooting starts and when it ends.
struct ShootingOptions {
  /// Flanks stay together whatever the sign of the mesh force: the orbit of a gear pair without
  /// backlash.
  bool bilateral_contact = false;
  int first_cycles = 0;         ///< periods integrated before Newton's method, without friction,
  bool renew_friction = false;  ///< or with, evaluated every 20 periods
  /// The Picard iteration ends at this relative error of the figures,
  double tolerance = 1e-6;
  /// or at this share of the change since the grid before: a grid that changes much is not the
  /// last.
  double share_of_change = 0;
};

}  // namespace tribodyn
