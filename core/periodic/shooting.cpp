#include "core/periodic/shooting.h"

#include <algorithm>
#include <utility>

namespace tribodyn {
Shooting::Shooting(const PeriodicProblem& problem, OrbitFriction& friction, const MeshGrid& grid,
                   const ShootingOptions& options, PeriodicOrbit& orbit)
    : problem_(problem),
      system_(problem.system),
      friction_(friction),
      grid_(grid),
      options_(options),
      orbit_(orbit),
      scales_(march_scales(system_, orbit.torques, problem.mean_pinion_speed)),
      mean_force_(scales_.torque / system_.mesh().mean_pinion_contact_radius()),
      period_time_(orbit.period * system_.cycle_angle() / problem.mean_pinion_speed) {
  const double of_torque =
      std::abs(orbit.torques.pinion) / system_.mesh().mean_pinion_contact_radius();
  light_load_ = 1e-3 * (of_torque < kLightForce ? of_torque : mean_force_);
  for (int i = 0; i + 1 < kUnknowns; ++i) scale_(i) = scales_.of(system_.mesh(), i + 1);
  scale_(kUnknowns - 1) = scales_.torque;
}

bool Shooting::solve(double tolerance) {
  // Near a doubling, where the roots of one and of two periods are close to each other, each of
  // Newton's steps leaves two thirds of the error: shrinking is less than 0.8. Of the random scenes
  // (core/README.md) one more is marched with 3 Jacobians, or with 6 while shrinking; 12 Jacobians,
  // and 10 or 40 steps, change nothing. The ratio of steps up to which a Jacobian is kept is not
  // critical: with 0.05 they take 0.6 % less work, with 0.5 0.2 % more.
  constexpr int kMostNewtonSteps = 20, kMostDerivatives = 6, kMostWhileShrinking = 16;
  constexpr double kShrinking = 0.8, kRatioToKeepJacobian = 0.2;
  double last = 0;
  int derivatives = 0;
  for (int i = 0; i < kMostNewtonSteps; ++i) {
    if (!orbit_.jacobian) ++derivatives;
    const double left = orbit_.defect = newton_step();
    if (!(left < 1e9)) return false;
    if (left < tolerance) return true;
    if (i > 0 && left > kRatioToKeepJacobian * last) {
      if (derivatives >= (left < kShrinking * last ? kMostWhileShrinking : kMostDerivatives)) {
        return false;
      }
      orbit_.jacobian.reset();
    }
    last = left;
  }
  return false;
}

void Shooting::throw_if_interrupted() const {
  if (problem_.interrupted && problem_.interrupted()) throw Cancelled();
}

bool Shooting::evaluate_friction(Nodes nodes) {
  std::swap(friction_before_, orbit_.friction);
  if (!evaluate(nodes)) return false;
  orbit_.friction_change = orbit_.friction.distance(friction_before_);
  orbit_.least_pressing_force = friction_.least_pressing_force() / mean_force_;
  orbit_.figures.torque = unknown_torque();
  return true;
}

}  // namespace tribodyn
