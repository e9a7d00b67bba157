#include "core/dynamics/orbit_solver.h"

#include <algorithm>
#include <utility>

#include "core/dynamics/single_shooting.h"

namespace tribodyn {
namespace {

/// Sweeps until friction and motion belong to each other.
bool sweep(Shooting& shooting, const OrbitRequest& request, PeriodicOrbit& orbit) {
  constexpr int kMostSweeps = 24;
  constexpr double kCaution = 3;  // on a response that is nearly the same for all of the friction
  const auto parts_for_sure = [&](double pull) {
    return request.keep_contact && orbit.least_pressing_force < -pull;
  };
  const bool first_friction = orbit.response == 0;
  double left = request.tolerance;
  if (first_friction) {
    if (!shooting.evaluate_friction(Shooting::Places::kFew)) return false;
    // Friction calms some responses.
    if (parts_for_sure(0.25)) return true;
  }
  OrbitFigures previous = orbit.figures;
  double ahead = 0;  // change of the figures by friction that has been evaluated since
  for (int sweep = 1; sweep < kMostSweeps; ++sweep) {
    // No better than the friction is known.
    const double enough = std::max({1e-11, 0.2 * request.tolerance, 0.1 * ahead});
    const double friction_change = orbit.friction_change, defect = orbit.defect;
    if (!shooting.converge(enough) || !shooting.evaluate_friction()) return false;
    const double change = orbit.figures.distance(previous);
    previous = orbit.figures;
    if (friction_change > 0 && first_friction && sweep == 1) {
      orbit.response = std::max(orbit.least_response, change / friction_change);
    } else if (friction_change > 0 && sweep > 1) {
      orbit.response = std::max(orbit.response, (change - defect - orbit.defect) / friction_change);
    }
    ahead = kCaution * orbit.response * orbit.friction_change;
    orbit.unsettled = ahead + orbit.defect;
    if (sweep == 1 && !first_friction) left = std::max(left, request.share_of_change * change);
    if (orbit.unsettled <= left || change < 1e-13) return true;
    if (parts_for_sure(kClearPull + change)) return true;
  }
  return false;
}

}  // namespace

OrbitSolver::OrbitSolver(GearPairSystem& system, const FlankContactBatch& contacts,
                         MarchStatistics& statistics, long& marched_cycles,
                         std::optional<double> coefficient)
    : system_(system),
      friction_(system, contacts, coefficient),
      statistics_(statistics),
      marched_cycles_(marched_cycles) {}

bool OrbitSolver::approach_without_friction(const MeshGrid& grid, const OrbitRequest& request,
                                            PeriodicOrbit& orbit) {
  constexpr double kNearEnough = 1e-3;  // friction changes the response by some percent
  if (MultipleShooting::applies(grid, request, orbit)) {
    PeriodicOrbit together = orbit;
    MultipleShooting shooting(system_, friction_, storage_, grid, request, together);
    const bool good = shooting.converge(kNearEnough);
    shooting.finish(statistics_, marched_cycles_);
    if (good) orbit = std::move(together);
    if (good) return true;
  }
  SingleShooting shooting(system_, friction_, grid, request, orbit);
  const bool good = shooting.let_run(request.first_cycles) && shooting.converge(kNearEnough);
  shooting.finish(statistics_, marched_cycles_);
  return good;
}

bool OrbitSolver::approach_from_near(const MeshGrid& grid, const OrbitRequest& request,
                                     PeriodicOrbit& orbit) {
  SingleShooting shooting(system_, friction_, grid, request, orbit);
  const bool good = shooting.let_run(1);
  shooting.finish(statistics_, marched_cycles_);
  return good;
}

bool OrbitSolver::solve(const MeshGrid& grid, const OrbitRequest& request, PeriodicOrbit& orbit) {
  const auto solve = [&](Shooting&& shooting) {
    const bool good = sweep(shooting, request, orbit);
    shooting.finish(statistics_, marched_cycles_);
    orbit.contacts = friction_.take_contacts();
    return good;
  };
  // On as it began.
  if (orbit.cycle_derivatives != nullptr && MultipleShooting::applies(grid, request, orbit)) {
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
