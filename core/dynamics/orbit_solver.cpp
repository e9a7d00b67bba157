#include "core/dynamics/orbit_solver.h"

#include <algorithm>

#include "core/dynamics/single_shooting.h"

namespace tribodyn {
namespace {

/// Sweeps until friction and motion belong to each other.
bool sweep(Shooting& shooting, const OrbitRequest& request, PeriodicOrbit& orbit) {
  constexpr int kMostSweeps = 24;
  constexpr double kLikelyContraction = 0.2, kUnmeasured = 0.3;
  constexpr double kCaution = 3;  // by experience they respond within a tenth as before
  const auto parts_for_sure = [&](double pull) {
    return request.keep_contact && orbit.least_pressing_force < -pull;
  };
  double last_change = 0, change_ahead = 0;
  const bool first_friction = orbit.contraction == 0;
  if (first_friction) {
    if (!shooting.estimate_friction()) return false;
    // Friction calms some responses.
    if (parts_for_sure(0.25)) return true;
    orbit.contraction = kLikelyContraction;
  }
  OrbitFigures previous = orbit.figures;
  for (int sweep = 1; sweep < kMostSweeps; ++sweep) {
    // No better than the friction is known.
    const double enough = std::max({1e-11, 0.2 * request.tolerance, 0.1 * change_ahead});
    if (!shooting.converge(enough) || !shooting.evaluate_friction()) return false;
    const double change = orbit.figures.distance(previous);
    previous = orbit.figures;
    if (first_friction && sweep == 1) orbit.response = change;  // to all of the friction
    if (orbit.friction_change > 0) {
      change_ahead = kCaution * orbit.response * orbit.friction_change;
      orbit.unsettled = change_ahead + orbit.defect;
    } else {
      // Sweeps contract like a geometric series; the first change is not theirs alone.
      const bool measured = last_change > 0;
      if (measured) orbit.contraction = std::clamp(change / last_change, 0.02, 0.9);
      const double contraction = std::max(orbit.contraction, measured ? 0.0 : kUnmeasured);
      const double moved = measured ? change : std::max(change, 0.1 * orbit.moved);
      orbit.unsettled = moved * contraction / (1 - contraction) + orbit.defect;
      change_ahead = orbit.contraction * change;
    }
    last_change = change;
    if (orbit.unsettled <= request.tolerance || change < 1e-13) return true;
    if (parts_for_sure(kClearPull + change)) return true;
  }
  return false;
}

}  // namespace

OrbitSolver::OrbitSolver(GearPairSystem& system, const FlankContactBatch& contacts,
                         MarchStatistics& statistics, long& marched_cycles)
    : system_(system),
      friction_(system, contacts),
      statistics_(statistics),
      marched_cycles_(marched_cycles) {}

bool OrbitSolver::approach_without_friction(const MeshGrid& grid, const OrbitRequest& request,
                                            PeriodicOrbit& orbit) {
  constexpr double kNearEnough = 1e-3;  // friction changes the response by some percent
  bool good = false;
  if (MultipleShooting::applies(grid, request, orbit)) {
    MultipleShooting together(system_, friction_, storage_, grid, request, orbit);
    good = together.converge(kNearEnough);
    together.finish(statistics_, marched_cycles_);
  } else {
    SingleShooting shooting(system_, friction_, grid, request, orbit);
    good = shooting.let_run(request.first_cycles) && shooting.converge(kNearEnough);
    shooting.finish(statistics_, marched_cycles_);
  }
  return good;
}

bool OrbitSolver::solve(const MeshGrid& grid, const OrbitRequest& request, PeriodicOrbit& orbit) {
  const auto solve = [&](Shooting&& shooting) {
    const bool good = sweep(shooting, request, orbit);
    shooting.finish(statistics_, marched_cycles_);
    return good;
  };
  if (MultipleShooting::applies(grid, request, orbit)) {
    return solve(MultipleShooting(system_, friction_, storage_, grid, request, orbit));
  }
  return solve(SingleShooting(system_, friction_, grid, request, orbit));
}

bool OrbitSolver::renew_map(const MeshGrid& grid, const OrbitRequest& request,
                            PeriodicOrbit& orbit) {
  SingleShooting shooting(system_, friction_, grid, request, orbit);
  const bool good = shooting.renew_map();
  shooting.finish(statistics_, marched_cycles_);
  return good;
}

}  // namespace tribodyn
