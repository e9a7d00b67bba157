#include "core/dynamics/single_shooting.h"

#include <algorithm>
#include <limits>

#include "core/dynamics/period_correction.h"

namespace tribodyn {

SingleShooting::SingleShooting(GearPairSystem& system, OrbitFriction& friction,
                               const MeshGrid& grid, const OrbitRequest& request,
                               PeriodicOrbit& orbit)
    : Shooting(system, friction, grid, request, orbit),
      march_(system, scales_, grid, orbit.period, request.solve_wheel_torque,
             std::clamp(1e-4 * request.tolerance, 1e-12, 1e-9), friction.instruction_set()) {}

bool SingleShooting::march(MarchState& state, Sensitivity* s) {
  throw_if_interrupted();
  start_regime(state);
  return march_.run(orbit_.friction, request_.keep_contact, state, s, &orbit_.pieces);
}

bool SingleShooting::let_run(int cycles) {
  constexpr int kRenewal = 20;
  for (int i = 0; i < cycles; ++i) {
    MarchState y = orbit_.state;
    if (!march(y, nullptr)) return false;
    if (request_.renew_friction && i % kRenewal == 0 && !evaluate_friction()) return false;
    correct_period(system_, orbit_.state, orbit_.period, request_.mean_pinion_speed,
                   request_.solve_wheel_torque, y);
    orbit_.state = y;
  }
  return true;
}

bool SingleShooting::renew_map() {
  constexpr double kHere = 1e-4;
  if (orbit_.moved_from_map < kHere && orbit_.pieces_of_map == orbit_.pieces.size()) return true;
  MarchState y = orbit_.state;
  Sensitivity sensitivity;
  start_regime(y);
  if (!march_.run(orbit_.friction, request_.keep_contact, y, &sensitivity, nullptr)) return false;
  orbit_.map.emplace(sensitivity, scale_, period_time_);
  orbit_.moved_from_map = 0;
  orbit_.pieces_of_map = orbit_.pieces.size();
  return true;
}

double SingleShooting::improve() {
  constexpr double kBrokenDown = std::numeric_limits<double>::quiet_NaN();
  MarchState y = orbit_.state;
  if (orbit_.map) {
    if (!march(y, nullptr)) return kBrokenDown;
  } else {
    Sensitivity sensitivity;
    if (!march(y, &sensitivity)) return kBrokenDown;
    orbit_.map.emplace(sensitivity, scale_, period_time_);
    orbit_.moved_from_map = 0;
    orbit_.pieces_of_map = orbit_.pieces.size();
  }
  SectionMap::Vector residual;
  for (int i = 0; i + 1 < kUnknowns; ++i) {
    residual(i) = (y[i + 1] - orbit_.state[i + 1]) / scale_(i);
  }
  residual(kUnknowns - 1) = y[kTime] / period_time_ - 1;
  const SectionMap::Vector step = orbit_.map->step(residual);
  for (int i = 0; i + 1 < kUnknowns; ++i) orbit_.state[i + 1] += scale_(i) * step(i);
  add_to_unknown(scale_(kUnknowns - 1) * step(kUnknowns - 1));
  orbit_.moved_from_map += step.norm();
  return step.norm();
}

bool SingleShooting::evaluate(Places) {
  orbit_.contact_loss = std::any_of(orbit_.pieces.begin(), orbit_.pieces.end(),
                                    [](const OrbitPiece& p) { return p.regime.side == 0; });
  return friction_.evaluate(grid_, orbit_.pieces, light_load(), orbit_.friction, orbit_.figures);
}

void SingleShooting::start_regime(const MarchState& state) {
  if (request_.keep_contact) {
    system_.regime = {side(), true};
  } else {
    system_.regime = system_.regime_of(0, state.data());
  }
  orbit_.regime = system_.regime;
}

void SingleShooting::finish(MarchStatistics& statistics, long& marched_cycles) {
  statistics.right_hand_sides += march_.evaluations();
  statistics.accepted_steps += march_.steps();
  statistics.events += march_.events();
  marched_cycles += march_.steps() / grid_.steps();
  orbit_.torques = system_.torques();
}

}  // namespace tribodyn
