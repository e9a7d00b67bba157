#include "core/periodic/single_shooting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/square.h"
#include "core/periodic/period_correction.h"

namespace tribodyn {

SingleShooting::SingleShooting(const PeriodicProblem& problem, OrbitFriction& friction,
                               const MeshGrid& grid, const ShootingOptions& options,
                               PeriodicOrbit& orbit)
    : Shooting(problem, friction, grid, options, orbit),
      march_(system_, scales_, grid, orbit.period, problem.solve_wheel_torque,
             std::clamp(1e-4 * options.tolerance, 1e-12, 1e-9), friction.instruction_set()) {
  // Over random scenes of a rich spectrum and up to threefold ripple the orbits that a march
  // confirms are within 0.22 of it, and the remote attractors beyond 1.8.
  farthest_ = 2 * system_.dynamics().half_backlash + scales_.length;
  if (!options.bilateral_contact && !orbit.marched) orbit.marched = orbit.state;
}

bool SingleShooting::march(MarchState& state, Sensitivity* s) {
  throw_if_interrupted();
  return march_.run(orbit_.torques, orbit_.friction, options_.bilateral_contact, state, s,
                    &orbit_.pieces);
}

bool SingleShooting::march_transient(int cycles) {
  // Periods from one evaluation of friction to the next. With 5 the sweeps of core/README.md take
  // 30 % more contacts, with 60 7 % fewer; their ends are the same.
  constexpr int kRenewal = 20;
  for (int i = 0; i < cycles; ++i) {
    MarchState y = orbit_.state;
    if (!march(y, nullptr)) return false;
    if (options_.renew_friction && i % kRenewal == 0 && !evaluate_friction()) return false;
    correct_period(system_, orbit_.state, orbit_.period, problem_.mean_pinion_speed,
                   problem_.solve_wheel_torque, orbit_.torques, y);
    orbit_.state = y;
  }
  if (cycles > 0) orbit_.marched = orbit_.state;
  return true;
}

double SingleShooting::distance_from_marched() const {
  double squares = 0;
  for (int i = 0; i + 1 < kUnknowns; ++i) {
    squares += square((orbit_.state[i + 1] - (*orbit_.marched)[i + 1]) / scale_(i));
  }
  return std::sqrt(squares) * scales_.length;
}

bool SingleShooting::renew_jacobian() {
  // Scaled. Not critical: with 0 and 1e-2 random scenes (core/README.md) come out the same.
  constexpr double kFreshJacobianDistance = 1e-4;
  if (orbit_.distance_since_jacobian < kFreshJacobianDistance &&
      orbit_.pieces_of_jacobian == orbit_.pieces.size())
    return true;
  MarchState y = orbit_.state;
  Sensitivity sensitivity;
  if (!march_.run(orbit_.torques, orbit_.friction, options_.bilateral_contact, y, &sensitivity,
                  nullptr)) {
    return false;
  }
  orbit_.jacobian.emplace(sensitivity, scale_, period_time_);
  orbit_.distance_since_jacobian = 0;
  orbit_.pieces_of_jacobian = orbit_.pieces.size();
  return true;
}

double SingleShooting::newton_step() {
  constexpr double kBrokenDown = std::numeric_limits<double>::quiet_NaN();
  MarchState y = orbit_.state;
  if (orbit_.jacobian) {
    if (!march(y, nullptr)) return kBrokenDown;
  } else {
    Sensitivity sensitivity;
    if (!march(y, &sensitivity)) return kBrokenDown;
    orbit_.jacobian.emplace(sensitivity, scale_, period_time_);
    orbit_.distance_since_jacobian = 0;
    orbit_.pieces_of_jacobian = orbit_.pieces.size();
  }
  PoincareMapJacobian::Vector residual;
  for (int i = 0; i + 1 < kUnknowns; ++i) {
    residual(i) = (y[i + 1] - orbit_.state[i + 1]) / scale_(i);
  }
  residual(kUnknowns - 1) = y[kTime] / period_time_ - 1;
  const PoincareMapJacobian::Vector step = orbit_.jacobian->step(residual);
  for (int i = 0; i + 1 < kUnknowns; ++i) orbit_.state[i + 1] += scale_(i) * step(i);
  unknown_torque() += scale_(kUnknowns - 1) * step(kUnknowns - 1);
  orbit_.distance_since_jacobian += step.norm();
  if (!options_.bilateral_contact && !(distance_from_marched() <= farthest_)) return kBrokenDown;
  return step.norm();
}

bool SingleShooting::evaluate(Nodes) {
  orbit_.contact_loss = std::any_of(orbit_.pieces.begin(), orbit_.pieces.end(),
                                    [](const OrbitPiece& p) { return p.regime.side == 0; });
  return friction_.evaluate(grid_, orbit_.pieces, orbit_.torques, light_load_, orbit_.friction,
                            orbit_.figures);
}

void SingleShooting::finish(SolverWork& work) {
  work.right_hand_sides += march_.evaluations();
  work.accepted_steps += march_.steps();
  work.events += march_.events();
  work.mesh_cycles += march_.steps() / grid_.steps();
}

}  // namespace tribodyn
