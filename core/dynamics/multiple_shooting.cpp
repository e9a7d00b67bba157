#include "core/dynamics/multiple_shooting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace tribodyn {
namespace {

constexpr int kUnknowns = SectionMap::kUnknowns;
constexpr int kStates = 7;
using Vector = SectionMap::Vector;
using Square = CycleDerivatives::Square;

/// Eigen's own of this size are made for large matrices.
Vector product(const Square& a, const Vector& x) {
  Vector even = a.col(0) * x(0), odd = a.col(1) * x(1);
  for (int j = 2; j < kUnknowns; j += 2) {
    even += a.col(j) * x(j);
    odd += a.col(j + 1) * x(j + 1);
  }
  return even + odd;
}
Square product(const Square& a, const Square& b) {
  Square out;
  for (int j = 0; j < kUnknowns; ++j) out.col(j) = product(a, Vector(b.col(j)));
  return out;
}

}  // namespace

bool MultipleShooting::applies(const MeshGrid& grid, const OrbitRequest& request,
                               const PeriodicOrbit& orbit) {
  return request.keep_contact && request.first_cycles == 0 && orbit.period == 1 &&
         grid.series_reach() > 0;
}

MultipleShooting::MultipleShooting(GearPairSystem& system, OrbitFriction& friction,
                                   const MeshGrid& grid, const OrbitRequest& request,
                                   PeriodicOrbit& orbit)
    : Shooting(system, friction, grid, request, orbit),
      instruction_set_(friction.instruction_set()),
      steps_(grid.steps()),
      block_{system, grid, side(), request.solve_wheel_torque, lagged_},
      end_(kUnknowns, steps_),
      particular_(steps_ + 1),
      duration_(steps_) {
  system.regime = orbit.regime = {block_.side, true};
  response_.start.resize(kResponseRows, steps_ + 1);
  response_.middle.resize(kResponseRows, steps_ + 1);
  response_.rate.resize(kUnknowns, steps_ + 1);
  lagged_.start.resize(kFrictionRows, steps_ + 1);
  lagged_.middle.resize(kFrictionRows, steps_ + 1);
  if (orbit.pieces.empty()) {
    start_from_state();
  } else {
    start_from_pieces();
  }
  spread_friction();
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

void MultipleShooting::spread_friction() {
  for (int node = 0; node <= 2 * steps_; ++node) {
    const FrictionPerLoad at = orbit_.friction.at(0.5 * node / steps_);
    Columns& to = node % 2 == 0 ? lagged_.start : lagged_.middle;
    to[kPinionFrictionRow][node / 2] = at.pinion;
    to[kGearFrictionRow][node / 2] = at.gear;
  }
}

void MultipleShooting::take_derivatives() {
  auto made = std::make_shared<CycleDerivatives>();
  made->steps.resize(steps_);
  Square from_section = Square::Identity();
  Vector time = Vector::Zero();
  for (int s = 0; s < steps_; ++s) {
    CycleDerivatives::Step& step = made->steps[s];
    for (int j = 0; j < kUnknowns; ++j) {
      step.duration(j) = derivatives_[j][s];
      for (int i = 0; i < kStates; ++i) {
        step.state(i, j) = derivatives_[kDerivativeColumns * (i + 1) + j][s];
      }
      step.state(kStates, j) = j == kStates ? 1 : 0;
    }
    step.from_section = from_section;
    for (int j = 0; j < kUnknowns; ++j) time(j) += from_section.col(j).dot(step.duration);
    from_section = product(step.state, from_section);
  }
  Sensitivity sensitivity;
  sensitivity[kTime] = time.transpose().array();
  for (int i = 0; i < kStates; ++i) sensitivity[i + 1] = from_section.row(i).array();
  orbit_.map.emplace(sensitivity, scale_, period_time_);
  orbit_.cycle_derivatives = std::move(made);
}

Shooting::Step MultipleShooting::improve() {
  constexpr double kBrokenDown = std::numeric_limits<double>::quiet_NaN();
  throw_if_interrupted();
  const bool anew = !orbit_.map || orbit_.cycle_derivatives == nullptr ||
                    static_cast<int>(orbit_.cycle_derivatives->steps.size()) != steps_;
  if (anew) derivatives_.resize(kDerivativeRows * kDerivativeColumns, steps_);
  if (!take_steps(instruction_set_, block_, response_, end_, anew ? &derivatives_ : nullptr)) {
    return {kBrokenDown, kBrokenDown};
  }
  evaluations_ += 4L * steps_;
  if (anew) take_derivatives();
  const std::vector<CycleDerivatives::Step>& derivatives = orbit_.cycle_derivatives->steps;

  // What the residuals alone do, from a section that does not move.
  Vector p = Vector::Zero();
  double time = 0;
  for (int s = 0; s < steps_; ++s) {
    particular_[s] = p;
    time += end_[kTime][s] + derivatives[s].duration.dot(p);
    p = product(derivatives[s].state, p);
    for (int i = 0; i < kStates; ++i) p(i) += end_[i + 1][s] - response_.start[i + 1][s + 1];
  }
  Vector residual = p.cwiseQuotient(scale_);
  residual(kStates) = time / period_time_ - 1;
  const Vector step = orbit_.map->step(residual);
  const Vector at_section = step.cwiseProduct(scale_);
  double longest = step.norm();
  for (int s = 0; s < steps_; ++s) {
    const Vector change = particular_[s] + product(derivatives[s].from_section, at_section);
    duration_[s] = end_[kTime][s] + derivatives[s].duration.dot(change);
    longest = std::max(longest, change.cwiseQuotient(scale_).norm());
    for (int i = 0; i < kStates; ++i) response_.start[i + 1][s] += change(i);
  }
  for (int i = 0; i < kStates; ++i) response_.start[i + 1][steps_] = response_.start[i + 1][0];
  add_to_unknown(at_section(kStates));
  is_filled_ = false;
  return {step.norm(), longest};
}

bool MultipleShooting::fill() {
  double time = 0;
  for (int s = 0; s <= steps_; ++s) {
    response_.start[kTime][s] = time;
    if (s < steps_) time += duration_[s];
  }
  is_filled_ = true;
  return fill_response(instruction_set_, block_, response_);
}

bool MultipleShooting::evaluate_friction() {
  if (!fill()) return false;
  const double light = 1e-3 * mean_force_;
  double least = std::numeric_limits<double>::infinity();
  for (int s = 0; s <= steps_; ++s) {
    least = std::min(least, block_.side * response_.start[kMeshForceRow][s]);
    if (s < steps_) least = std::min(least, block_.side * response_.middle[kMeshForceRow][s]);
  }
  bool good = false;
  if (least > light) {
    good = friction_.evaluate(block_, response_, orbit_.friction, orbit_.figures);
  } else {
    write_pieces();
    good = friction_.evaluate(grid_, orbit_.pieces, light, orbit_.friction, orbit_.figures);
  }
  if (!good) return false;
  take_figures();
  orbit_.contact_loss = false;
  spread_friction();
  return true;
}

void MultipleShooting::write_pieces() {
  orbit_.pieces.resize(steps_);
  for (int s = 0; s < steps_; ++s) {
    OrbitPiece& piece = orbit_.pieces[s];
    piece = {};
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

void MultipleShooting::finish(MarchStatistics& statistics, long& marched_cycles) {
  statistics.right_hand_sides += evaluations_;
  statistics.accepted_steps += evaluations_ / 4;
  marched_cycles += evaluations_ / (4L * steps_);
  if (!is_filled_) fill();
  write_pieces();
  orbit_.state = orbit_.pieces.front().start;
  orbit_.torques = system_.torques();
}

}  // namespace tribodyn
