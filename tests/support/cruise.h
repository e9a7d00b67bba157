#pragma once

#include "core/study/operating_point.h"

namespace tribodyn {

/// Returns the steady road load on a level road at a vehicle speed [km/h].
inline OperatingCondition cruise(double kilometres_per_hour) {
  OperatingCondition condition;
  condition.vehicle_speed = kilometres_per_hour / 3.6;
  return condition;
}

/// Returns a condition with T_s [N m] and the speed of the pinion [rad/s].
inline OperatingCondition prescribed(double pinion_torque, double pinion_speed) {
  OperatingCondition condition;
  condition.kind = OperatingCondition::Kind::kPrescribedTorque;
  condition.pinion_torque = pinion_torque;
  condition.pinion_speed = pinion_speed;
  return condition;
}

}  // namespace tribodyn
