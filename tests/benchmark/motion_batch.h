#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "tests/benchmark/periodic_rivals.h"

namespace tribodyn {

inline constexpr int kStates = kMotionStates;  ///< time and the seven states of motion
using StateColumn = Eigen::Matrix<double, kStates, 1>;
using StateMatrix = Eigen::Matrix<double, kStates, kStates>;

struct MotionInstant {
  double phase = 0;  ///< [cycles], 0 to 1
  MarchState state{};
  // Set by MotionBatch::evaluate():
  ContactRegime regime;
  Mechanics at;
  MarchState rate{};
};

/// Evaluates the motion at many instants, their contacts in one batch, and scales it.
class MotionBatch {
 public:
  /// Keeps the reference. `instants`: how many at most.
  MotionBatch(const RivalProblem& problem, std::size_t instants);

  void evaluate(std::span<MotionInstant> instants, const Torques& torques);

  /// The scaled rates' derivatives by the scaled states at an evaluated instant, with the friction
  /// arms held.
  StateMatrix slopes(const MotionInstant& x) const;
  /// The same by T_s over torque_scale(), of the one state that it changes at once.
  static constexpr int kTurned = kPinionShaftSpeed;
  double slope_by_torque(const MotionInstant& x) const;

  double scale(int component) const { return scale_[component]; }  ///< of MarchComponent
  double torque_scale() const { return torque_scale_; }            ///< [N m]
  /// Duration of a mesh cycle over its scale.
  double scaled_period() const;
  /// A relative tolerance times the scale of each component.
  std::vector<double> tolerances(double relative) const;

 private:
  /// What one phase decides.
  struct Slot {
    double phase = -1;
    MeshPhase mesh;
    std::array<FlankKinematics, kFlankPairs> flanks;
  };
  struct Contact {
    std::size_t instant;
    FlankMotion motion;
  };

  void set_phase(std::size_t i, double phase);

  const RivalProblem& problem_;
  MarchState scale_{};
  double torque_scale_;
  std::vector<Slot> slots_;
  ContactGeometries all_, solved_;  // by slot and flank pair; of the contacts under load
  std::vector<Contact> contacts_;
  std::array<std::vector<double>, 6> columns_;  // conditions of the contacts, friction
  Instant scratch_;
};

}  // namespace tribodyn
