#include "core/periodic/coulomb_orbits.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/periodic/grid_convergence.h"
#include "core/periodic/orbit_solver.h"

namespace tribodyn {
namespace {

// Of the scenes that coulomb_orbits.h names: with 0.025 they take 0.8 % fewer contacts and with
// 0.1 5.3 % more. Lubricated flanks are between 0.02 and 0.1.
constexpr double kCoefficient = 0.05;
// Found at 37.7 km/h (see below); those scenes do not need it.
constexpr double kOtherCoefficient = 0.02;
// Of the gain under Coulomb's friction, a lower bound of the lubricant's, which may be less. Not
// critical: with 0.1 and 1 they take 0.3 % fewer and 0.8 % more contacts, and the estimates bound
// as well.
constexpr double kShareOfGain = 0.6;

/// The error of the steps on the first grid by the response under another friction. It changes
/// linearly with the coefficient of friction and may pass through zero near any one coefficient (at
/// 37.7 km/h 16 steps err by 1.5e-4 under 0.05 and by 6.4e-4 under 0.02), and there is no coarser
/// grid that would show it. `last`: on the finest grid. Infinite if a response is not found.
double error_by_other_friction(OrbitSolver& solver, MeshGrids& grids,
                               const ShootingOptions& options, const PeriodicOrbit& first,
                               const PeriodicOrbit& last) {
  PeriodicOrbit coarse = first, fine = last;
  if (!solver.solve(grids.with_steps(first.steps_per_mesh_cycle), options, coarse) ||
      !solver.solve(grids.with_steps(last.steps_per_mesh_cycle), options, fine)) {
    return std::numeric_limits<double>::infinity();
  }
  return last.estimated_error + coarse.figures.distance(fine.figures);
}

}  // namespace

std::vector<PeriodicOrbit> coulomb_orbits(const PeriodicProblem& problem,
                                          const ShootingOptions& options,
                                          const PeriodicOrbit& origin, int least) {
  // With 3 grids the scenes that coulomb_orbits.h names take 1.1 % more contacts, with 8 the
  // same.
  constexpr std::size_t kMostGrids = 5;
  constexpr double kSmallStepError = kShareOfSteps * kLooseTolerance / kCoulombErrorFactor;
  // Not critical: with 1e-4 and 1e-6 they take 0.1 % fewer and 0.2 % more.
  constexpr double kPicardTolerance = 1e-5;
  SolverWork work;
  OrbitSolver solver(problem, work, kCoefficient);
  ShootingOptions precise = options;
  precise.tolerance = kPicardTolerance;
  PeriodicOrbit orbit = origin;
  std::vector<PeriodicOrbit> out;
  GridComparison comparison(problem);
  const StepSequence sequence(problem.system.mesh().intervals(), least);
  for (int steps = sequence.first(); out.size() < kMostGrids && steps <= kMostStepsPerCycle;
       steps = sequence.after(steps, 1)) {
    const MeshGrid& grid = problem.grids.with_steps(steps);
    if (out.empty() && !solver.solve_without_friction(grid, precise, orbit)) break;
    precise.first_cycles = 0;
    if (!solver.solve(grid, precise, orbit)) break;
    const double error =
        out.empty() ? 0 : comparison.error(grid, orbit.figures) + orbit.picard_error;
    comparison.add(steps, orbit.figures, error);
    PeriodicOrbit& added = out.emplace_back(orbit);
    added.estimated_error = error;
    // A lubricant's friction is yet to come.
    added.friction_gain_floor = kShareOfGain * std::exchange(added.friction_gain, 0);
    added.contacts.reset();
    const bool parts =
        options.bilateral_contact && orbit.least_pressing_force < -kTensionForSeparation;
    if (parts || (out.size() > 1 && error < kSmallStepError)) break;
  }
  problem.tally.take_refusal();
  if (out.size() == 1) out.front().estimated_error = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < out.size(); ++i) {
    out[i].estimated_error =
        out.back().estimated_error + out[i].figures.distance(out.back().figures);
  }
  const auto finer = [&](std::size_t i) {
    return static_cast<double>(out[i].steps_per_mesh_cycle) / out[i - 1].steps_per_mesh_cycle;
  };
  if (out.size() > 1 && out[0].estimated_error < finer(1) * finer(1) * out[1].estimated_error) {
    OrbitSolver other(problem, work, kOtherCoefficient);
    out[0].estimated_error =
        std::max(out[0].estimated_error,
                 error_by_other_friction(other, problem.grids, precise, out[0], out.back()));
    problem.tally.take_refusal();
  }
  // An error below that of second-order steps may be an accident of one friction coefficient.
  for (std::size_t i = 1; i + 1 < out.size(); ++i) {
    out[i].estimated_error =
        std::max(out[i].estimated_error, out[i - 1].estimated_error / (2 * finer(i) * finer(i)));
  }
  return out;
}

const std::vector<PeriodicOrbit>& CoulombOrbits::find(const PeriodicProblem& problem,
                                                      const ShootingOptions& options,
                                                      const PeriodicOrbit& origin, int least) {
  Key key{static_cast<double>(least),
          static_cast<double>(options.bilateral_contact),
          static_cast<double>(options.first_cycles),
          static_cast<double>(problem.solve_wheel_torque),
          static_cast<double>(origin.period),
          problem.mean_pinion_speed,
          origin.torques.pinion,
          origin.torques.wheel};
  std::copy(origin.state.begin(), origin.state.end(), key.begin() + 8);
  if (const auto known = found_.find(key); known != found_.end()) return known->second;
  if (steps_kept_ > kMostStepsKept) {
    found_.clear();
    steps_kept_ = 0;
  }
  auto made = coulomb_orbits(problem, options, origin, least);
  for (const PeriodicOrbit& each : made) steps_kept_ += each.steps_per_mesh_cycle;
  return found_.emplace(key, std::move(made)).first->second;
}

}  // namespace tribodyn
