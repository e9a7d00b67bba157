#include "core/study/operating_target.h"

#include <cmath>

#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {

OperatingTarget target_of(const Scene& scene, const OperatingCondition& c) {
  const double ratio = static_cast<double>(scene.gear_set.pinion_teeth) / scene.gear_set.gear_teeth;
  OperatingTarget t{};
  if (c.kind == OperatingCondition::Kind::kPrescribedTorque) {
    t.mean_pinion_speed = c.pinion_speed;
    t.vehicle_speed = c.pinion_speed * ratio * scene.vehicle.wheel_radius;
    t.torques = {c.pinion_torque, c.pinion_torque / ratio};
    t.solve_wheel_torque = true;
  } else {
    const double acceleration =
        c.kind == OperatingCondition::Kind::kDriveCycleSnapshot ? c.acceleration : 0;
    t.vehicle_speed = c.vehicle_speed;
    t.mean_pinion_speed = c.vehicle_speed / scene.vehicle.wheel_radius / ratio;
    const double wheel = wheel_torque(scene.vehicle, c.vehicle_speed, c.ascent_angle, acceleration);
    t.torques = {wheel * ratio, wheel};
  }
  if (!(t.mean_pinion_speed > 0) || !std::isfinite(t.mean_pinion_speed)) {
    throw Refusal("NO_FORWARD_ROTATION", "the mean pinion speed must be positive; it is " +
                                             number_text(t.mean_pinion_speed) + " rad/s");
  }
  return t;
}

PeriodicProblem PointProblem::periodic(double tolerance) const {
  PeriodicProblem out{system(),
                      contacts,
                      gear_set.grids(),
                      tally,
                      target.torques,
                      target.mean_pinion_speed,
                      target.solve_wheel_torque,
                      tolerance,
                      {}};
  if (options.progress) {
    out.interrupted = [&progress = options.progress] { return !progress(0); };
  }
  return out;
}

PointResult empty_result(const OperatingTarget& target, PointModel model) {
  PointResult out;
  out.vehicle_speed = target.vehicle_speed;
  out.mean_pinion_speed = target.mean_pinion_speed;
  out.model = model;
  return out;
}

std::optional<double> known_error(double estimate) {
  return std::isfinite(estimate) ? std::optional(estimate) : std::nullopt;
}

}  // namespace tribodyn
