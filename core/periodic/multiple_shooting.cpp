#include "core/periodic/multiple_shooting.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

namespace tribodyn {
namespace {

constexpr int kTorqueUnknown = PoincareMapJacobian::kUnknowns - 1;
using Vector = PoincareMapJacobian::Vector;

}  // namespace

bool MultipleShooting::applies(const MeshGrid& grid, const ShootingOptions& options,
                               const PeriodicOrbit& orbit) {
  return options.bilateral_contact && options.first_cycles == 0 && orbit.period == 1 &&
         grid.series_reach() > 0;
}

MultipleShooting::MultipleShooting(const PeriodicProblem& problem, OrbitFriction& friction,
                                   CycleStorage& storage, const MeshGrid& grid,
                                   const ShootingOptions& options, PeriodicOrbit& orbit)
    : Shooting(problem, friction, grid, options, orbit),
      instruction_set_(friction.instruction_set()),
      steps_(grid.steps()),
      response_(storage.response),
      frozen_(storage.frozen),
      end_(storage.end),
      derivatives_(storage.derivatives),
      change_(storage.change),
      duration_(storage.duration),
      block_{system_,
             orbit.torques,
             grid,
             orbit.torques.pinion >= 0 ? 1 : -1,
             problem.solve_wheel_torque,
             frozen_} {
  // The torque has a residual of its own: 0.
  for (int i = 0; i < kTorqueUnknown; ++i) per_scale_[i] = 1 / scale_(i);
  end_.resize_for_overwrite(kUnknowns, steps_);
  change_.resize(kUnknowns * (steps_ + 1));
  duration_.resize(steps_);
  response_.start.resize_for_overwrite(kResponseRows, steps_ + 1);
  response_.middle.resize_for_overwrite(kResponseRows, steps_ + 1);
  response_.rate.resize_for_overwrite(kUnknowns, steps_ + 1);
  frozen_.start.resize_for_overwrite(kFrictionRows, steps_ + 1);
  frozen_.middle.resize_for_overwrite(kFrictionRows, steps_ + 1);
  if (orbit.pieces.empty()) {
    start_from_state();
  } else {
    start_from_pieces();
  }
  set_friction();
}

void MultipleShooting::start_from_state() {
  for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
    std::fill_n(response_.start[i], steps_ + 1, orbit_.state[i]);
  }
  std::fill(duration_.begin(), duration_.end(), period_time_ / steps_);
}

void MultipleShooting::start_from_pieces() {
  const auto& pieces = orbit_.pieces;
  std::size_t at = 0;
  for (int s = 0; s < steps_; ++s) {
    const double phase = static_cast<double>(s) / steps_;
    while (at + 1 < pieces.size() && pieces[at + 1].phase <= phase + 1e-12) ++at;
    const OrbitPiece& p = pieces[at];
    // By the parabola through its start, middle and end.
    const double t = (phase - p.phase) / p.length;
    const double start = (1 - t) * (1 - 2 * t), middle = 4 * t * (1 - t), end = t * (2 * t - 1);
    for (int i = kTime; i <= kWheelSpeed; ++i) {
      response_.start[i][s] = start * p.start[i] + middle * p.middle[i] + end * p.end[i];
    }
  }
  const double* const time = response_.start[kTime];
  for (int s = 0; s < steps_; ++s) {
    duration_[s] = (s + 1 < steps_ ? time[s + 1] : pieces.back().end[kTime]) - time[s];
  }
  for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
    response_.start[i][0] = response_.start[i][steps_] = orbit_.state[i];
  }
}

void MultipleShooting::set_friction() {
  for (int node = 0; node <= 2 * steps_; ++node) {
    const FrictionArms at = orbit_.friction.at(static_cast<double>(node) / (2 * steps_),
                                               static_cast<std::size_t>(node));
    Columns& to = node % 2 == 0 ? frozen_.start : frozen_.middle;
    to[kPinionFrictionRow][node / 2] = at.pinion;
    to[kGearFrictionRow][node / 2] = at.gear;
  }
}

void MultipleShooting::set_jacobian() {
  auto made = std::make_shared<CycleDerivatives>(steps_);
  compose_derivatives(instruction_set_, derivatives_, *made);
  Sensitivity sensitivity;
  constexpr std::size_t kMatrix = CycleDerivatives::kMatrix;
  const double* const whole = made->from_section.get() + kMatrix * steps_;
  for (int j = 0; j < kUnknowns; ++j) {
    for (int i = 0; i < kTorqueUnknown; ++i) sensitivity[i + 1](j) = whole[kUnknowns * j + i];
    double time = 0;
    for (int s = 1; s <= steps_; ++s) {
      time += made->from_section[kMatrix * s + kUnknowns * j + kTorqueUnknown];
    }
    sensitivity[kTime](j) = time;
  }
  orbit_.jacobian.emplace(sensitivity, scale_, period_time_);
  orbit_.cycle_derivatives = std::move(made);
  orbit_.distance_since_jacobian = std::numeric_limits<double>::infinity();
}

double MultipleShooting::newton_step() {
  constexpr double kBrokenDown = std::numeric_limits<double>::quiet_NaN();
  throw_if_interrupted();
  const bool anew = !orbit_.jacobian || orbit_.cycle_derivatives == nullptr ||
                    orbit_.cycle_derivatives->steps != steps_;
  if (anew) derivatives_.resize_for_overwrite(CycleDerivatives::kMatrix, steps_);
  if (!rk4_steps(instruction_set_, block_, response_, end_, anew ? &derivatives_ : nullptr)) {
    return kBrokenDown;
  }
  evaluations_ += 4L * steps_;
  if (anew) set_jacobian();
  const CycleDerivatives& derivatives = *orbit_.cycle_derivatives;

  // From a section that does not move, what is missing at the end; then the section moves.
  condense_residuals(instruction_set_, derivatives, response_, end_, change_.data());
  const auto change_at = [&](int s) { return change_.data() + kUnknowns * s; };
  double time = 0;
  for (int s = 1; s <= steps_; ++s) time += change_at(s)[kTorqueUnknown];
  Vector residual;
  for (int i = 0; i < kTorqueUnknown; ++i) residual(i) = change_at(steps_)[i] * per_scale_[i];
  residual(kTorqueUnknown) = time / period_time_ - 1;
  const Vector step = orbit_.jacobian->step(residual);
  std::array<double, kUnknowns> at_section{};
  for (int i = 0; i < kUnknowns; ++i) at_section[i] = step(i) * scale_(i);
  const double length =
      std::max(step.norm(), expand_section_update(instruction_set_, derivatives, at_section.data(),
                                                  per_scale_.data(), change_.data()));
  for (int i = 0; i < kTorqueUnknown; ++i) {
    double* const start = response_.start[i + 1];
    for (int s = 0; s < steps_; ++s) start[s] += change_at(s)[i];
    start[steps_] = start[0];
  }
  for (int s = 0; s < steps_; ++s) duration_[s] = change_at(s + 1)[kTorqueUnknown];
  unknown_torque() += at_section[kTorqueUnknown];
  is_filled_ = false;
  // The ratio of two steps with the same Jacobian estimates the distance that is left; with a new
  // Jacobian the first step shrinks the distance twice as much as the following ones will.
  const double shorter = last_step_ > 0 && !anew ? 2 * length / last_step_ : 1;
  last_step_ = length;
  return shorter < 0.5 ? length * shorter / (1 - shorter) : length;
}

bool MultipleShooting::fill() {
  double time = 0;
  for (int s = 0; s <= steps_; ++s) {
    response_.start[kTime][s] = time;
    if (s < steps_) time += duration_[s];
  }
  is_filled_ = true;
  return complete_midpoints(instruction_set_, block_, response_);
}

bool MultipleShooting::evaluate(Nodes nodes) {
  last_step_ = 0;
  if (!fill()) return false;
  double least = std::numeric_limits<double>::infinity();
  for (int s = 0; s <= steps_; ++s) {
    least = std::min(least, block_.side * response_.start[kMeshForceRow][s]);
    if (s < steps_) least = std::min(least, block_.side * response_.middle[kMeshForceRow][s]);
  }
  bool good = false;
  if (least > light_load_) {
    const GridContacts& contacts =
        nodes == Nodes::kAll ? grid_.contacts() : grid_.contacts_at_starts();
    good = friction_.evaluate(block_, contacts, response_, orbit_.friction, orbit_.figures);
  } else {
    write_pieces();
    good = friction_.evaluate(grid_, orbit_.pieces, orbit_.torques, light_load_, orbit_.friction,
                              orbit_.figures);
  }
  if (!good) return false;
  orbit_.contact_loss = false;
  set_friction();
  return true;
}

void MultipleShooting::write_pieces() {
  orbit_.pieces.resize(steps_);
  for (int s = 0; s < steps_; ++s) {
    OrbitPiece& piece = orbit_.pieces[s];
    piece.phase = static_cast<double>(s) / steps_;
    piece.length = 1.0 / steps_;
    piece.node = 2 * s;
    piece.regime = {block_.side, true};
    for (int i = 0; i < kUnknowns; ++i) {
      piece.start[i] = response_.start[i][s];
      piece.middle[i] = response_.middle[i][s];
      piece.end[i] = response_.start[i][s + 1];
    }
  }
}

void MultipleShooting::finish(SolverWork& work) {
  work.right_hand_sides += evaluations_;
  work.accepted_steps += evaluations_ / 4;
  work.mesh_cycles += evaluations_ / (4L * steps_);
  if (!is_filled_) fill();
  write_pieces();
  orbit_.state = orbit_.pieces.front().start;
}

}  // namespace tribodyn
