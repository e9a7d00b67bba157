#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/study/operating_point.h"

namespace tribodyn {

enum class SweepDirection { kUp, kDown };

struct SweepOptions {
  SweepDirection direction = SweepDirection::kUp;
  /// Start and model apply to the first point, or to every point of independent ones; progress to
  /// the whole sweep; sensitivities to every point, not to those that locate the end of a branch.
  PointOptions point;
  /// Each point is solved alone, from its own start: the same bits as solve_operating_point gives.
  /// No branch is followed and no end of a branch is looked for, which takes most of a sweep's
  /// time.
  bool independent_points = false;
};

/// Where the branch that a sweep follows ends, as at a fold: the response jumps. In the sweep's
/// direction.
struct BranchEnd {
  double followed_to = 0;  ///< the last speed on the branch [m/s]
  /// The nearest speed at which it is not found [m/s]: 0.04 km/h farther, or more where hardly any
  /// response attracts and some hundred mesh cycles of marching do not decide.
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

/// Cruise points over `vehicle_speeds` [m/s]: natural-parameter continuation in the order of the
/// direction (R. Seydel, Practical Bifurcation and Stability Analysis, 3rd ed., 2010, chapter 4).
///  1. Each point starts from the steady state before it (but see
///     SweepOptions::independent_points).
///  2. Two neighbours may be on different branches if flanks part at one of them only, if the
///     period differs, or if the swing of the transmission error differs by 30 %.
///  3. The interval between them is then bisected: each middle starts from the last point on the
///     branch and becomes that point, or the point beyond, by its kind and its swing. If the swings
///     close up, there is no jump; otherwise it lies between the last two speeds.
///  4. By kAutomatic shooting bisects first. Where it finds nothing, as near a fold or a period
///     doubling, the other branch is followed to there, or some hundred mesh cycles are marched at
///     a speed.
/// A branch that is left and found again between two neighbours is not noticed. With kShooting an
/// end is reported only if shooting finds the branch beyond it. Returned in ascending speed.
/// `on_point` is called after each. `gear_set`: as of solve_operating_point.
std::vector<SweepPoint> sweep_speed(const Scene& scene, std::vector<double> vehicle_speeds,
                                    double ascent_angle, const SweepOptions& options,
                                    const std::function<void(const SweepPoint&)>& on_point = {},
                                    const std::shared_ptr<PreparedGearSet>& gear_set = nullptr);

}  // namespace tribodyn
