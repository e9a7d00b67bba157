#include "core/periodic/orbit_solver.h"

#include <algorithm>
#include <utility>

#include "core/periodic/single_shooting.h"

namespace tribodyn {
namespace {

/// Iterates friction and motion (Picard) until neither changes the other.
bool picard_iterate(Shooting& shooting, const ShootingOptions& options, PeriodicOrbit& orbit) {
  constexpr int kMostIterations = 24;  // with 12 random scenes come out the same
  // Factor on the gain of the figures over the friction, which differs a little along the orbit.
  // With 1 the smallest percentile of estimate over error of random scenes (core/README.md) falls
  // from 2.8 to 2.1, with 9 they take 0.7 % more work.
  constexpr double kCaution = 3;
  const auto separates = [&](double tension) {
    return options.bilateral_contact && orbit.least_pressing_force < -tension;
  };
  const bool first_friction = orbit.friction_gain == 0;
  double left = options.tolerance;
  if (first_friction) {
    if (!shooting.evaluate_friction(Shooting::Nodes::kStarts)) return false;
    // Friction reduces the tension of some orbits: a quarter of the mean force is sure. With 0.1
    // the sweeps (core/README.md) leave the branch that ends at 71.4 km/h 0.03 to 0.07 km/h early.
    if (separates(0.25)) return true;
  }
  OrbitFigures previous = orbit.figures;
  double ahead = 0;  // change of the figures by friction that has been evaluated since
  for (int iteration = 1; iteration < kMostIterations; ++iteration) {
    // The motion need not be solved better than its friction is known.
    const double enough = std::max({1e-11, 0.2 * options.tolerance, 0.1 * ahead});
    const double friction_change = orbit.friction_change, defect = orbit.defect;
    if (!shooting.solve(enough) || !shooting.evaluate_friction()) return false;
    const double change = orbit.figures.distance(previous);
    previous = orbit.figures;
    if (friction_change > 0 && first_friction && iteration == 1) {
      orbit.friction_gain = std::max(orbit.friction_gain_floor, change / friction_change);
    } else if (friction_change > 0 && iteration > 1) {
      orbit.friction_gain =
          std::max(orbit.friction_gain, (change - defect - orbit.defect) / friction_change);
    }
    ahead = kCaution * orbit.friction_gain * orbit.friction_change;
    orbit.picard_error = ahead + orbit.defect;
    if (iteration == 1 && !first_friction) left = std::max(left, options.share_of_change * change);
    if (orbit.picard_error <= left || change < 1e-13) return true;
    if (separates(kTensionForSeparation + change)) return true;
  }
  return false;
}

}  // namespace

OrbitSolver::OrbitSolver(const PeriodicProblem& problem, SolverWork& work,
                         std::optional<double> coefficient)
    : problem_(problem),
      friction_(problem.system, problem.contacts, problem.tally, problem.tolerance, coefficient),
      work_(work) {}

bool OrbitSolver::solve_without_friction(const MeshGrid& grid, const ShootingOptions& options,
                                         PeriodicOrbit& orbit) {
  // Scaled. Friction changes the orbit by some percent; with 1e-4 and 1e-2 random scenes
  // (core/README.md) take 0.1 % more and 0.2 % less work.
  constexpr double kFrictionlessTolerance = 1e-3;
  if (MultipleShooting::applies(grid, options, orbit)) {
    PeriodicOrbit together = orbit;
    MultipleShooting shooting(problem_, friction_, storage_, grid, options, together);
    const bool good = shooting.solve(kFrictionlessTolerance);
    shooting.finish(work_);
    if (good) orbit = std::move(together);
    if (good) return true;
  }
  SingleShooting shooting(problem_, friction_, grid, options, orbit);
  const bool good =
      shooting.march_transient(options.first_cycles) && shooting.solve(kFrictionlessTolerance);
  shooting.finish(work_);
  return good;
}

bool OrbitSolver::march_one_period(const MeshGrid& grid, const ShootingOptions& options,
                                   PeriodicOrbit& orbit) {
  SingleShooting shooting(problem_, friction_, grid, options, orbit);
  const bool good = shooting.march_transient(1);
  shooting.finish(work_);
  return good;
}

bool OrbitSolver::solve(const MeshGrid& grid, const ShootingOptions& options,
                        PeriodicOrbit& orbit) {
  const auto solve = [&](Shooting&& shooting) {
    const bool good = picard_iterate(shooting, options, orbit);
    shooting.finish(work_);
    orbit.contacts = friction_.take_contacts();
    orbit.steps_per_mesh_cycle = grid.steps();
    return good;
  };
  // An orbit keeps the form of shooting that it began with.
  if (orbit.cycle_derivatives != nullptr && MultipleShooting::applies(grid, options, orbit)) {
    return solve(MultipleShooting(problem_, friction_, storage_, grid, options, orbit));
  }
  return solve(SingleShooting(problem_, friction_, grid, options, orbit));
}

bool OrbitSolver::renew_jacobian(const MeshGrid& grid, const ShootingOptions& options,
                                 PeriodicOrbit& orbit) {
  SingleShooting shooting(problem_, friction_, grid, options, orbit);
  const bool good = shooting.renew_jacobian();
  shooting.finish(work_);
  return good;
}

}  // namespace tribodyn
