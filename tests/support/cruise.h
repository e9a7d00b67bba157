#pragma once

#include "core/study/operating_point.h"

namespace tribodyn {

/// Steady road load on the level at a vehicle speed [km/h].
inline OperatingCondition cruise(double kilometers_per_hour) {
  OperatingCondition condition;
  condition.vehicle_speed = kilometers_per_hour / 3.6;
  return condition;
}

}  // namespace tribodyn
