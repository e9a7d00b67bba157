#pragma once

#include "core/dynamics/gear_pair_system.h"
#include "core/study/operating_point.h"

namespace tribodyn {

/// Speed and torques that an operating condition fixes; the unknown torque without friction.
struct OperatingTarget {
  double mean_pinion_speed;  ///< [rad/s]
  double vehicle_speed;      ///< [m/s]
  Torques torques;
  bool solve_wheel_torque;  ///< T_w is the unknown instead of T_s
};

/// Throws Refusal NO_FORWARD_ROTATION.
OperatingTarget target_of(const Scene& scene, const OperatingCondition& condition);

}  // namespace tribodyn
