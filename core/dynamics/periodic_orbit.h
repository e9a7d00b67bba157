#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/dynamics/fixed_step_march.h"
#include "core/dynamics/section_map.h"
#include "core/dynamics/steady_state.h"

namespace tribodyn {

struct CycleDerivatives;

/// Where shooting begins, and what it has found so far.
struct PeriodicOrbit {
  MarchState state{};    ///< at mesh phase 0
  ContactRegime regime;  ///< there
  Torques torques;
  int period = 1;  ///< [mesh cycles]
  LaggedFriction friction;
  std::optional<SectionMap> map;  ///< from here or near; empty: not known
  /// How far the state has moved since the map was made from steps one by one, at most, scaled, and
  /// of how many pieces the response was then.
  double moved_from_map = std::numeric_limits<double>::infinity();
  std::size_t pieces_of_map = 0;
  /// Of all steps, where they have been taken side by side.
  std::shared_ptr<const CycleDerivatives> cycle_derivatives;
  std::vector<OrbitPiece> pieces;
  std::shared_ptr<const SolvedContacts> contacts;  ///< of the pieces, once a response is found
  OrbitFigures figures;
  double defect = 0;  ///< scaled change of the state in the last step of Newton, or what it left
  /// What the last evaluation changed of the friction, relative (LaggedFriction::distance).
  double friction_change = 0;
  /// Of the figures to all of the friction, relative; 0: not known. They go nearly in proportion.
  double response = 0;
  double least_response = 0;  ///< by what a response nearby has shown
  double unsettled = 0;       ///< estimate of what further sweeps would still change, relative
  bool contact_loss = false;
  /// Smallest force that pressed touching flanks together, over the mean one; negative: they were
  /// held together.
  double least_pressing_force = 0;
};

/// Of the mean force; flanks kept together that pull harder than this do part.
inline constexpr double kClearPull = 0.02;

struct OrbitRequest {
  double mean_pinion_speed = 0;     ///< held exactly [rad/s]
  bool solve_wheel_torque = false;  ///< T_w is the unknown instead of T_s
  bool keep_contact = false;    ///< flanks stay together whatever the force: the linear response
  int first_cycles = 0;         ///< periods marched before shooting without friction,
  bool renew_friction = false;  ///< or with, evaluated anew now and then
  double tolerance = 1e-6;      ///< of the figures, relative: sweeps go on until then,
  /// or until they leave this share of what a change of the grid has changed: a grid that changes
  /// much is not the last.
  double share_of_change = 0;
  std::function<bool()> interrupted;  ///< true: throws Cancelled
};

}  // namespace tribodyn
