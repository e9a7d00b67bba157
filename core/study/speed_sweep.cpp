#include "core/study/speed_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
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

/// The longest relative change of speed in which no multiplier can pass a bifurcation unseen.
///
/// Multipliers of a mode turn about the origin as the mesh cycle changes its duration: by the angle
/// through which the mode swings in a period, times the relative change of speed. The step takes
/// the nearest multiplier half of the way to the bifurcation.
double longest_step(const std::array<LinearMode, 3>& modes, const GearPairSystem& system,
                    const PointResult& r) {
  // A bifurcation that comes and goes within it is missed. With 0.0025 and 0.01 the sweeps of
  // core/README.md report the same ends.
  constexpr double kShortest = 0.005;
  constexpr double kShare = 0.5;
  const double nearest = std::min(r.statistics.distance_to_flip, r.statistics.distance_to_fold);
  if (!(nearest > 0)) return std::numeric_limits<double>::infinity();
  const double mesh = r.mean_pinion_speed * system.mesh().pinion_teeth();
  double fastest = 0;
  for (const LinearMode& mode : modes) {
    const double angle = 2 * std::numbers::pi * r.period_in_mesh_cycles * mode.frequency / mesh;
    fastest = std::max(fastest, angle * std::exp(-mode.damping * angle));
  }
  return std::max(kShortest, kShare * nearest / fastest);
}

BranchPoint on_branch(PreparedScene& scene, const PointResult& r) {
  PreparedGearSet& gear_set = scene.gear_set();
  return {
      r.vehicle_speed, r.dynamic_transmission_error.maximum - r.dynamic_transmission_error.minimum,
      r.settled,       r.method == SteadyStateMethod::kMarch ? r.statistics.mesh_cycles : 0,
      carried_from(r), longest_step(gear_set.modes(), gear_set.system(), r)};
}

/// Solves between two neighbours of a sweep with the options of the sweep, but loosely and without
/// what only its own points have. Adds to `contact_solutions`; keeps the references.
BranchSolver branch_solver(PreparedScene& scene, double ascent_angle, PointOptions options,
                           long& contact_solutions) {
  options.maximum_mesh_cycles = std::min(options.maximum_mesh_cycles, kMostBranchCycles);
  options.tolerance = std::max(options.tolerance, kBranchTolerance);
  options.history = {};
  options.probe_coexisting_response = options.warn_of_coexisting_response = false;
  options.sensitivities = false;
  const auto solve = [&scene, &contact_solutions, ascent_angle](
                         double speed, const PointOptions& here) -> std::optional<BranchPoint> {
    try {
      const PointResult r = solve_prepared_point(scene, cruise(speed, ascent_angle), here);
      contact_solutions += r.statistics.contact_solutions;
      return on_branch(scene, r);
    } catch (const Refusal&) {
      return std::nullopt;
    }
  };
  const auto solve_by = [solve, options](SteadyStateMethod method) -> SolveOnBranch {
    return [solve, options, method](double speed, const BranchPoint& from) {
      PointOptions here = options;
      here.method = method;
      here.carried_state = from.state;
      return solve(speed, here);
    };
  };
  BranchSolver out;
  if (options.method != SteadyStateMethod::kMarch) {
    out.by_shooting = solve_by(SteadyStateMethod::kShooting);
    out.loud = [solve, options](double speed) {
      PointOptions here = options;
      here.method = SteadyStateMethod::kShooting;
      here.start = PointStart::kLargeVibration;
      here.carried_state.reset();
      return solve(speed, here);
    };
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
      std::optional<BranchPoint> before;
      BranchSolver solver;
      if (follows && !out.empty() && out.back().result) {
        solver = branch_solver(*prepared, ascent_angle, point, next.contact_solutions_of_search);
        before = follow_towards(speed, on_branch(*prepared, *out.back().result), solver,
                                next.branch_end);
        point.carried_state = before->state;
      }
      const auto solve = [&] {
        return solve_prepared_point(*prepared, cruise(speed, ascent_angle), point);
      };
      try {
        next.result = solve();
      } catch (const Refusal&) {
        // Contacts may be refused on the branch that was followed, and not on that of the point.
        if (!before || before->speed == out.back().vehicle_speed) throw;
        before = on_branch(*prepared, *out.back().result);
        point.carried_state = before->state;
        next.branch_end.reset();
        next.result = solve();
      }
      if (follows) point.carried_state = carried_from(*next.result);
      if (before && !next.branch_end) {
        const BranchPoint after = on_branch(*prepared, *next.result);
        if (may_be_branches(*before, after)) {
          next.branch_end = find_branch_end(*before, after, solver);
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
