#pragma once

#include <array>
#include <vector>

#include "core/driveline/frozen_friction.h"
#include "core/driveline/gear_pair_system.h"
#include "core/integrate/mesh_cycle_march.h"
#include "core/integrate/mesh_grid.h"
#include "core/integrate/orbit_piece.h"
#include "core/integrate/step_sensitivity.h"

namespace tribodyn {

/// Classical Runge-Kutta steps of even length over mesh phase, under frozen friction. Steps end on
/// contact loss, regain and load events, which are located on true steps: by secants from the
/// root on the cubic through both ends, or else inside a bracket.
///
/// The variational equations give the derivatives of the state by the state at the start and by the
/// unknown torque. Where flanks part or meet, the rates f of the state jump: by the damper's force
/// with damping_in_contact_only, and by friction where flanks meet under a load. There the
/// saltation matrix takes the derivatives S across,
///   S+ = (I + (f+ - f-) (dx/dy)^T / (dx/dphase)) S-,
/// with x the transmission error, whose value +-b is the event. At load events f is continuous.
/// (R. I. Leine and H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems,
/// Springer 2004, section 7.4.)
class Rk4WithEvents {
 public:
  /// The grid's steps in each of `period` mesh cycles. Events are located to `event_tolerance`, of
  /// the scales of length and force. Keeps the references.
  Rk4WithEvents(const GearPairSystem& system, const MarchScales& scales, const MeshGrid& grid,
                int period, bool solve_wheel_torque, double event_tolerance,
                InstructionSet instruction_set);

  /// Integrates one period from `state`, in the regime that the state is in, or with
  /// `bilateral_contact` in contact of the side that the pinion torque presses, whatever the sign
  /// of the mesh force. Time and works start from zero. Returns false if the pinion stops, events
  /// do not end, or a number is not finite.
  bool run(const Torques& torques, FrozenFriction& friction, bool bilateral_contact,
           MarchState& state, Sensitivity* sensitivity, std::vector<OrbitPiece>* pieces);

  long evaluations() const { return evaluations_; }
  long steps() const { return taken_; }
  long events() const { return events_; }

 private:
  using Rates = std::array<double, 8>;
  using Events = std::array<double, 2>;
  /// A step's start, middle and end.
  struct Span {
    double phase, length;  ///< [cycles]
    const MeshPhase *start, *middle, *end;
  };
  void step(FrozenFriction& friction, const Span& span, const MarchState& y, MarchState& to);
  /// Into the regime after event 0 or 1, with the derivatives unless they are null.
  void change_regime(int event, const FrictionArms& friction, const MeshPhase& phase,
                     const MarchState& y, Sensitivity* sensitivity);
  template <class Part>
  double locate(FrozenFriction& friction, int index, double first, double last, double high,
                Part&& part, const MarchState& y, MarchState& to);
  MarchState middle(const MarchState& from, const MarchState& to, double h) const;
  Events events(const MeshPhase& phase, const MarchState& y) const;

  const GearPairSystem& system_;
  const MarchScales& scales_;
  const MeshGrid& grid_;
  int period_;
  double event_tolerance_;
  InstructionSet instruction_set_;
  TorqueSlopes by_torque_;
  long evaluations_ = 0, taken_ = 0, events_ = 0;
  Torques torques_;
  ContactRegime regime_;  // at the phase reached
  // Of the last step.
  Rates first_rate_{}, last_rate_{};
  bool store_stages_ = false;
  std::array<MotionSlopes, 4> stages_;
};

}  // namespace tribodyn
