#include "core/study/speed_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/refusal.h"

namespace tribodyn {
namespace {

OperatingCondition cruise(double speed, double ascent_angle) {
  OperatingCondition condition;
  condition.kind = OperatingCondition::Kind::kCruise;
  condition.vehicle_speed = speed;
  condition.ascent_angle = ascent_angle;
  return condition;
}

/// How much wider the one's transmission error swings than the other's, over the wider swing.
double distance(const PointResult& a, const PointResult& b) {
  const auto swing = [](const PointResult& r) {
    return r.dynamic_transmission_error.maximum - r.dynamic_transmission_error.minimum;
  };
  const double larger = std::max(swing(a), swing(b));
  return larger > 0 ? std::abs(swing(a) - swing(b)) / larger : 0;
}

/// Whether flanks part in both or in neither, and both repeat after as many mesh cycles. Responses
/// of two kinds are on two branches, or their branch changes its kind in between without a jump.
bool of_one_kind(const PointResult& a, const PointResult& b) {
  return a.contact_loss == b.contact_loss && a.period_in_mesh_cycles == b.period_in_mesh_cycles;
}

bool may_be_branches(const PointResult& a, const PointResult& b) {
  // Relative. Not critical: with 0.15 and 0.6 the sweeps report the same ends.
  constexpr double kSwingDifferenceOfBranches = 0.3;
  return a.settled && b.settled &&
         (!of_one_kind(a, b) || distance(a, b) > kSwingDifferenceOfBranches);
}

// The constants below were varied over the sweeps of core/README.md.

// Distance of swings, relative, up to which two responses are on one branch. With 0.05 the sweeps
// report the same ends, with 0.2 the one at 155.8 km/h, where the period doubles, is missed.
constexpr double kSameBranchDistance = 0.1;
// Width to which an end is located [m/s], as BranchEnd states; not tuned.
constexpr double kSpeedResolution = 0.04 / 3.6;
constexpr double kUnlimitedStride = std::numeric_limits<double>::infinity();

/// Where a branch may end: a response on it, one on another, and between them or at the other one
/// the nearest speed at which the branch is not found.
struct Bracket {
  PointResult before, beyond;
  double gone_at;    // [m/s]
  long cycles_left;  // to march, where shooting does not decide
};

/// Whether a response found in between is on the branch rather than with the response beyond. Over
/// a wide step swings of one branch may differ more than those of two: the kind decides first.
bool is_on_branch(const Bracket& bracket, const PointResult& found) {
  if (of_one_kind(found, bracket.before) && !of_one_kind(found, bracket.beyond)) return true;
  return distance(bracket.before, found) <= distance(found, bracket.beyond);
}

/// Solves at a speed from the branch and narrows the bracket to either side of it. Returns false if
/// the branch connects to the response beyond, so that there is no end between them.
bool narrow_at(PreparedScene& scene, double ascent_angle, double speed, PointOptions options,
               Bracket& bracket) {
  options.carried_state = carried_from(bracket.before);
  PointResult found;
  try {
    found = solve_prepared_point(scene, cruise(speed, ascent_angle), options);
  } catch (const Refusal&) {
    bracket.gone_at = speed;
    return true;
  }
  if (found.method == SteadyStateMethod::kMarch) {
    bracket.cycles_left -= found.statistics.mesh_cycles;
  }
  const double first = distance(bracket.before, found), second = distance(found, bracket.beyond);
  if (found.settled && of_one_kind(bracket.before, bracket.beyond) &&
      std::max(first, second) < kSameBranchDistance) {
    return false;
  }
  if (found.settled && is_on_branch(bracket, found)) {
    bracket.before = std::move(found);
    return true;
  }
  bracket.gone_at = speed;
  if (found.settled) bracket.beyond = std::move(found);
  return true;
}

/// Repeats narrow_at(), halving the bracket, until it is as narrow as the speed resolution or no
/// mesh cycles are left to march. `stride`: the longest first step from the branch [m/s]; doubled
/// after each. Returns false if narrow_at() does.
bool narrow(PreparedScene& scene, double ascent_angle, const PointOptions& options, double stride,
            Bracket& bracket) {
  for (;; stride *= 2) {
    const double width = bracket.gone_at - bracket.before.vehicle_speed;
    if (std::abs(width) <= 1.001 * kSpeedResolution || bracket.cycles_left <= 0) return true;
    const double step =
        std::copysign(std::max(std::min(0.5 * std::abs(width), stride), kSpeedResolution), width);
    const double speed = bracket.before.vehicle_speed + step;
    if (!narrow_at(scene, ascent_angle, speed, options, bracket)) return false;
  }
}

/// Follows a response to a speed, or as near to it as its branch reaches, with steps that are
/// doubled on the branch and halved where it is missed.
PointResult follow(PreparedScene& scene, double ascent_angle, PointOptions options,
                   PointResult from, double to) {
  constexpr int kMostPoints = 24;  // a limit of work: with 8 the sweeps report the same ends
  double step = to - from.vehicle_speed;
  for (int i = 0; i < kMostPoints && from.vehicle_speed != to; ++i) {
    const bool arrives = std::abs(to - from.vehicle_speed) <= std::abs(step);
    options.carried_state = carried_from(from);
    try {
      PointResult next = solve_prepared_point(
          scene, cruise(arrives ? to : from.vehicle_speed + step, ascent_angle), options);
      if (!may_be_branches(from, next)) {
        from = std::move(next);
        step *= 2;
        continue;
      }
    } catch (const Refusal&) {  // a shorter step may stay on the branch
    }
    step /= 2;
    if (std::abs(step) < kSpeedResolution) break;
  }
  return from;
}

/// Whether a branch ends between two points of a sweep, and where; of several ends one.
std::optional<BranchEnd> branch_end(PreparedScene& scene, double ascent_angle, PointOptions options,
                                    const PointResult& before, const PointResult& after) {
  // Mesh cycles at a speed: more than the periods that shooting integrates in doubt
  // (find_orbit.cpp, 300 of one mesh cycle). With 150 the sweeps down across 65 km/h take twenty
  // times as long.
  constexpr int kMostCycles = 400;
  constexpr int kMostMarched = 600;  // of all points marched; with 200 and 2000 the same ends
  const bool only_marched = options.method == SteadyStateMethod::kMarch;
  options.maximum_mesh_cycles = std::min(options.maximum_mesh_cycles, kMostCycles);
  options.tolerance = std::max(options.tolerance, 0.01 * kSameBranchDistance);
  options.history = {};
  options.probe_coexisting_response = false;
  options.sensitivities = false;
  Bracket bracket{before, after, after.vehicle_speed,
                  only_marched ? std::numeric_limits<long>::max() : kMostMarched};
  if (!only_marched) {
    PointOptions quick = options;
    quick.method = SteadyStateMethod::kShooting;  // close to an end marching takes its time
    if (!narrow(scene, ascent_angle, quick, kUnlimitedStride, bracket)) return std::nullopt;
    if (bracket.gone_at != bracket.beyond.vehicle_speed) {
      if (options.method == SteadyStateMethod::kShooting) return std::nullopt;
      // Where the period changes orbits hardly attract, and a march takes its time: the other
      // branch decides, followed to where this one is not found.
      if (bracket.before.period_in_mesh_cycles != bracket.beyond.period_in_mesh_cycles) {
        const PointResult there =
            follow(scene, ascent_angle, quick, bracket.beyond, bracket.gone_at);
        if (std::abs(there.vehicle_speed - bracket.gone_at) < 4 * kSpeedResolution) {
          if (distance(bracket.before, there) < kSameBranchDistance) return std::nullopt;
          return BranchEnd{bracket.before.vehicle_speed, bracket.gone_at};
        }
      }
      // The branch may go on with another period, or attract too weakly for shooting to decide.
      const double speed = std::exchange(bracket.gone_at, bracket.beyond.vehicle_speed);
      if (!narrow_at(scene, ascent_angle, speed, options, bracket)) return std::nullopt;
    }
  }
  if (!narrow(scene, ascent_angle, options, only_marched ? kUnlimitedStride : 2 * kSpeedResolution,
              bracket)) {
    return std::nullopt;
  }
  if (distance(bracket.before, bracket.beyond) < kSameBranchDistance) return std::nullopt;
  return BranchEnd{bracket.before.vehicle_speed, bracket.gone_at};
}

}  // namespace

std::vector<SweepPoint> sweep_speed(const Scene& scene, std::vector<double> vehicle_speeds,
                                    double ascent_angle, const SweepOptions& options,
                                    const std::function<void(const SweepPoint&)>& on_point,
                                    const std::shared_ptr<PreparedGearSet>& gear_set) {
  std::sort(vehicle_speeds.begin(), vehicle_speeds.end());
  vehicle_speeds.erase(std::unique(vehicle_speeds.begin(), vehicle_speeds.end()),
                       vehicle_speeds.end());
  if (options.direction == SweepDirection::kDown) {
    std::reverse(vehicle_speeds.begin(), vehicle_speeds.end());
  }
  std::optional<PreparedScene> prepared;
  std::vector<SweepPoint> out;
  PointOptions point = options.point;
  const bool follows = !options.independent_points;
  // Only the full model has branches to follow.
  if (follows && point.model == PointModel::kAutomatic) point.model = PointModel::kFull;
  const double count = static_cast<double>(vehicle_speeds.size());
  for (const double speed : vehicle_speeds) {
    const double done = static_cast<double>(out.size());
    if (options.point.progress) {
      point.progress = [&](double fraction) {
        return options.point.progress((done + fraction) / count);
      };
    }
    SweepPoint next;
    next.vehicle_speed = speed;
    try {
      if (!prepared) prepared.emplace(scene, gear_set);
      next.result = solve_prepared_point(*prepared, cruise(speed, ascent_angle), point);
      if (follows) point.carried_state = carried_from(*next.result);
      if (follows && !out.empty() && out.back().result &&
          may_be_branches(*out.back().result, *next.result)) {
        next.branch_end =
            branch_end(*prepared, ascent_angle, point, *out.back().result, *next.result);
      }
    } catch (const Refusal& refusal) {
      next.refusal_reason = refusal.reason();
      next.refusal_sentence = refusal.what();
      point.carried_state.reset();
    }
    if (on_point) on_point(next);
    out.push_back(std::move(next));
  }
  std::sort(out.begin(), out.end(), [](const SweepPoint& a, const SweepPoint& b) {
    return a.vehicle_speed < b.vehicle_speed;
  });
  return out;
}

}  // namespace tribodyn
