#include "core/study/speed_sweep.h"

#include <algorithm>
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

BranchPoint on_branch(const PointResult& r) {
  return {r.vehicle_speed,
          r.dynamic_transmission_error.maximum - r.dynamic_transmission_error.minimum, r.settled,
          r.method == SteadyStateMethod::kMarch ? r.statistics.mesh_cycles : 0, carried_from(r)};
}

/// Solves between two neighbours of a sweep with the options of the sweep, but loosely and without
/// what only its own points have. Adds to `contact_solutions`; keeps the references.
BranchSolver branch_solver(PreparedScene& scene, double ascent_angle, PointOptions options,
                           long& contact_solutions) {
  options.maximum_mesh_cycles = std::min(options.maximum_mesh_cycles, kMostBranchCycles);
  options.tolerance = std::max(options.tolerance, kBranchTolerance);
  options.history = {};
  options.probe_coexisting_response = false;
  options.sensitivities = false;
  const auto solve_by = [&scene, &contact_solutions, ascent_angle,
                         options](SteadyStateMethod method) -> SolveOnBranch {
    return [&scene, &contact_solutions, ascent_angle, options, method](
               double speed, const BranchPoint& from) -> std::optional<BranchPoint> {
      PointOptions here = options;
      here.method = method;
      here.carried_state = from.state;
      try {
        const PointResult r = solve_prepared_point(scene, cruise(speed, ascent_angle), here);
        contact_solutions += r.statistics.contact_solutions;
        return on_branch(r);
      } catch (const Refusal&) {
        return std::nullopt;
      }
    };
  };
  BranchSolver out;
  if (options.method != SteadyStateMethod::kMarch) {
    out.by_shooting = solve_by(SteadyStateMethod::kShooting);
  }
  if (options.method != SteadyStateMethod::kShooting) out.by_any_method = solve_by(options.method);
  return out;
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
      if (follows && !out.empty() && out.back().result) {
        const BranchPoint before = on_branch(*out.back().result), after = on_branch(*next.result);
        if (may_be_branches(before, after)) {
          next.branch_end = find_branch_end(
              before, after,
              branch_solver(*prepared, ascent_angle, point, next.contact_solutions_of_search));
        }
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
