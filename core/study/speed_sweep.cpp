#include "core/study/speed_sweep.h"

#include <algorithm>
#include <cmath>

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

bool may_be_branches(const PointResult& a, const PointResult& b) {
  constexpr double kFar = 0.3;
  return a.settled && b.settled &&
         (a.contact_loss != b.contact_loss || a.period_in_mesh_cycles != b.period_in_mesh_cycles ||
          distance(a, b) > kFar);
}

/// Whether a branch ends between two points of a sweep, and where; of several ends one.
std::optional<BranchEnd> branch_end(PreparedScene& scene, double ascent_angle, PointOptions options,
                                    PointResult before, PointResult after) {
  constexpr double kNear = 0.1;           // what is on one branch goes on like that
  constexpr double kEnough = 0.04 / 3.6;  // [m/s]
  PointOptions patient = options;
  patient.maximum_mesh_cycles = std::min(patient.maximum_mesh_cycles, 1000);
  options.method = SteadyStateMethod::kShooting;  // close to an end marching takes its time
  bool beyond_is_known = true;
  options.tolerance = std::max(options.tolerance, 0.1 * kNear);
  options.history = {};
  options.probe_coexisting_response = false;
  while (std::abs(after.vehicle_speed - before.vehicle_speed) > 1.001 * kEnough) {
    const double ahead = 0.5 * (after.vehicle_speed - before.vehicle_speed);
    const double step = std::copysign(std::max(std::abs(ahead), kEnough), ahead);
    options.carried_state = carried_from(before);
    const double speed = before.vehicle_speed + step;
    PointResult between;
    try {
      between = solve_prepared_point(scene, cruise(speed, ascent_angle), options);
    } catch (const Refusal&) {
      after.vehicle_speed = speed;  // the branch is not found there
      beyond_is_known = false;
      continue;
    }
    const double first = distance(before, between), second = distance(between, after);
    if (std::max(first, second) < kNear) return std::nullopt;
    if (first > second) beyond_is_known = true;
    (first > second ? after : before) = std::move(between);
  }
  if (!beyond_is_known) {  // it may go on in another way, as with a period that doubles
    try {
      patient.carried_state = carried_from(before);
      after = solve_prepared_point(scene, cruise(after.vehicle_speed, ascent_angle), patient);
    } catch (const Refusal&) {
      return std::nullopt;
    }
    if (!after.settled) return std::nullopt;
  }
  if (distance(before, after) < kNear) return std::nullopt;
  return BranchEnd{before.vehicle_speed, after.vehicle_speed};
}

}  // namespace

std::vector<SweepPoint> sweep_speed(const Scene& scene, std::vector<double> vehicle_speeds,
                                    double ascent_angle, const SweepOptions& options,
                                    const std::function<void(const SweepPoint&)>& on_point) {
  std::sort(vehicle_speeds.begin(), vehicle_speeds.end());
  vehicle_speeds.erase(std::unique(vehicle_speeds.begin(), vehicle_speeds.end()),
                       vehicle_speeds.end());
  if (options.direction == SweepDirection::kDown) {
    std::reverse(vehicle_speeds.begin(), vehicle_speeds.end());
  }
  std::optional<PreparedScene> prepared;
  std::vector<SweepPoint> out;
  PointOptions point = options.point;
  // A branch is followed from point to point.
  if (point.model == PointModel::kAutomatic) point.model = PointModel::kFull;
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
      if (!prepared) prepared.emplace(scene);
      next.result = solve_prepared_point(*prepared, cruise(speed, ascent_angle), point);
      point.carried_state = carried_from(*next.result);
      if (!out.empty() && out.back().result && may_be_branches(*out.back().result, *next.result)) {
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
