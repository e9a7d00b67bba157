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

/// Where the branch that a sweep follows ends, as at a fold: the response jumps. In the sweep's
/// direction.
struct BranchEnd {
  double followed_to = 0;  ///< the last speed on the branch [m/s]
  /// Where it is not found any more [m/s]: 0.04 km/h on, or more where hardly anything attracts and
  /// some hundred mesh cycles of marching do not tell.
  double gone_at = 0;
};

/// One point of a sweep: a result, or the reason why there is none. A refused point does not end
/// the sweep; the next one starts afresh.
struct SweepPoint {
  double vehicle_speed = 0;  ///< [m/s]
  std::optional<PointResult> result;
  std::string refusal_reason;  ///< when there is no result
  std::string refusal_sentence;
  std::optional<BranchEnd> branch_end;  ///< on the way here from the point before
};

/// Cruise points over `vehicle_speeds` [m/s], visited in the order of the direction, each started
/// from the steady state before it. Where neighbours differ like two branches, the speed is halved
/// in between until a jump is located or there is none, by the points' method: by shooting first
/// and then, where that cannot tell, by some hundred mesh cycles of marching at a speed; by either
/// alone where it is asked for. By kShooting alone no end is told that it does not see beyond.
/// Returned in ascending speed. `on_point` is called after each.
std::vector<SweepPoint> sweep_speed(const Scene& scene, std::vector<double> vehicle_speeds,
                                    double ascent_angle, const SweepOptions& options,
                                    const std::function<void(const SweepPoint&)>& on_point = {});

}  // namespace tribodyn
