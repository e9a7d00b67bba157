#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/study/operating_point.h"

namespace tribodyn {

enum class SweepDirection { kUp, kDown };

struct SweepOptions {
  SweepDirection direction = SweepDirection::kUp;
  PointOptions point;  ///< start and progress apply to the first point and to the whole sweep
};

/// One point of a sweep: a result, or the reason why there is none. A refused point does not end
/// the sweep; the next one starts afresh.
struct SweepPoint {
  double vehicle_speed = 0;  ///< [m/s]
  std::optional<PointResult> result;
  std::string refusal_reason;  ///< when there is no result
  std::string refusal_sentence;
};

/// Cruise points over `vehicle_speeds` [m/s], visited in the order of the direction, each started
/// from the steady state before it. Returned in ascending speed. `on_point` is called after each.
std::vector<SweepPoint> sweep_speed(const Scene& scene, std::vector<double> vehicle_speeds,
                                    double ascent_angle, const SweepOptions& options,
                                    const std::function<void(const SweepPoint&)>& on_point = {});

}  // namespace tribodyn
