#include "core/dynamics/periodic_orbit.h"

#include <algorithm>

#include "core/dynamics/multiple_shooting.h"
#include "core/dynamics/single_shooting.h"

namespace tribodyn {
namespace {

/// Sweeps until friction and motion belong to each other.
bool sweep(Shooting& shooting, const OrbitRequest& request, PeriodicOrbit& orbit) {
  constexpr int kMostSweeps = 24;
  constexpr double kLikelyContraction = 0.2, kUnmeasured = 0.3;
  const auto parts_for_sure = [&](double pull) {
    return request.keep_contact && orbit.least_pressing_force < -pull;
  };
  double last_change = 0;
  if (orbit.contraction == 0) {
    if (!shooting.evaluate_friction()) return false;
    // Friction calms some responses.
    if (parts_for_sure(0.25)) return true;
    orbit.contraction = kLikelyContraction;
  }
  OrbitFigures previous = orbit.figures;
  for (int sweep = 1; sweep < kMostSweeps; ++sweep) {
    // No better than the friction is known.
    const double enough =
        std::max({1e-11, 0.2 * request.tolerance, 0.1 * orbit.contraction * last_change});
    if (!shooting.converge(enough) || !shooting.evaluate_friction()) return false;
    const double change = orbit.figures.distance(previous);
    previous = orbit.figures;
    // Sweeps contract like a geometric series; the first change is not theirs alone.
    const bool measured = last_change > 0;
    if (measured) orbit.contraction = std::clamp(change / last_change, 0.02, 0.9);
    last_change = change;
    const double contraction = std::max(orbit.contraction, measured ? 0.0 : kUnmeasured);
    const double moved = measured ? change : std::max(change, 0.1 * orbit.moved);
    orbit.unsettled = moved * contraction / (1 - contraction) + orbit.defect;
    if (orbit.unsettled <= request.tolerance || change < 1e-13) return true;
    if (parts_for_sure(kClearPull + change)) return true;
  }
  return false;
}

}  // namespace

bool approach_without_friction(GearPairSystem& system, OrbitFriction& friction,
                               const MeshGrid& grid, const OrbitRequest& request,
                               PeriodicOrbit& orbit, MarchStatistics& statistics,
                               long& marched_cycles) {
  constexpr double kNearEnough = 1e-3;  // friction changes the response by some percent
  if (MultipleShooting::applies(grid, request, orbit)) {
    MultipleShooting together(system, friction, grid, request, orbit);
    const bool good = together.converge(kNearEnough);
    together.finish(statistics, marched_cycles);
    return good;
  }
  SingleShooting shooting(system, friction, grid, request, orbit);
  const bool good = shooting.let_run(request.first_cycles) && shooting.converge(kNearEnough);
  shooting.finish(statistics, marched_cycles);
  return good;
}

bool solve_periodic_orbit(GearPairSystem& system, OrbitFriction& friction, const MeshGrid& grid,
                          const OrbitRequest& request, PeriodicOrbit& orbit,
                          MarchStatistics& statistics, long& marched_cycles) {
  const auto solve = [&](Shooting&& shooting) {
    const bool good = sweep(shooting, request, orbit);
    shooting.finish(statistics, marched_cycles);
    return good;
  };
  if (MultipleShooting::applies(grid, request, orbit)) {
    return solve(MultipleShooting(system, friction, grid, request, orbit));
  }
  return solve(SingleShooting(system, friction, grid, request, orbit));
}

bool renew_map(GearPairSystem& system, OrbitFriction& friction, const MeshGrid& grid,
               const OrbitRequest& request, PeriodicOrbit& orbit, MarchStatistics& statistics,
               long& marched_cycles) {
  SingleShooting shooting(system, friction, grid, request, orbit);
  const bool good = shooting.renew_map();
  shooting.finish(statistics, marched_cycles);
  return good;
}

}  // namespace tribodyn
