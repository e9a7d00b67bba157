#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/periodic/branch_end.h"
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

/// One point of a sweep: a result, or the reason why there is none. A refused point does not end
/// the sweep; the next one starts afresh.
struct SweepPoint {
  double vehicle_speed = 0;  ///< [m/s]
  std::optional<PointResult> result;
  std::string refusal_reason;  ///< when there is no result
  std::string refusal_sentence;
  std::optional<BranchEnd> branch_end;  ///< on the way here from the point before
  /// Contacts solved in the search for that end, whether or not one was found; those of refused
  /// solutions are not counted.
  long contact_solutions_of_search = 0;
};

/// Cruise points over `vehicle_speeds` [m/s]: natural-parameter continuation in the order of the
/// direction (R. Seydel, Practical Bifurcation and Stability Analysis, 3rd ed., 2010, chapter 4).
///  1. Each point starts from the steady state before it (but see
///     SweepOptions::independent_points). Where a wide step might miss a bifurcation, the branch is
///     followed to there through points between them, so that a curve does not depend on the number
///     of its points.
///  2. Between neighbours that may be on different branches the end of the branch is looked for
///     (periodic/branch_end.h). With kShooting an end is reported only if shooting finds the branch
///     beyond it.
/// Returned in ascending speed. `on_point` is called after each. `gear_set`: as of
/// solve_operating_point.
std::vector<SweepPoint> sweep_speed(const Scene& scene, std::vector<double> vehicle_speeds,
                                    double ascent_angle, const SweepOptions& options,
                                    const std::function<void(const SweepPoint&)>& on_point = {},
                                    const std::shared_ptr<PreparedGearSet>& gear_set = nullptr);

}  // namespace tribodyn
