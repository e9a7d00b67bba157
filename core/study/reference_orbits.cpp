#include "core/study/reference_orbits.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/dynamics/orbit_solver.h"
#include "core/study/grid_comparison.h"
#include "core/study/step_sequence.h"

namespace tribodyn {
namespace {

constexpr double kCoefficient = 0.05;  // of friction; lubricated flanks are between 0.02 and 0.1
constexpr double kOtherCoefficient = 0.02;
constexpr double kShareOfResponse = 0.6;  // a lubricant's may be less

/// The error of the steps on the first grid by the response under another friction. It changes
/// linearly with the coefficient of friction and may pass through zero near any one coefficient (at
/// 37.7 km/h 16 steps err by 1.5e-4 under 0.05 and by 6.4e-4 under 0.02), and there is no coarser
/// grid that would show it. `last`: on the finest grid. Infinite if a response is not found.
double error_by_other_friction(OrbitSolver& solver, MeshGrids& grids, const OrbitRequest& request,
                               const ReferenceOrbit& first, const ReferenceOrbit& last) {
  PeriodicOrbit coarse = first.orbit, fine = last.orbit;
  if (!solver.solve(grids.with_steps(first.steps), request, coarse) ||
      !solver.solve(grids.with_steps(last.steps), request, fine)) {
    return std::numeric_limits<double>::infinity();
  }
  return last.step_error + coarse.figures.distance(fine.figures);
}

}  // namespace

std::vector<ReferenceOrbit> reference_orbits(GearPairSystem& system,
                                             const FlankContactBatch& contacts, MeshGrids& grids,
                                             const OrbitRequest& request,
                                             const PeriodicOrbit& origin, int least) {
  constexpr std::size_t kMostGrids = 5;
  constexpr double kSmall = kShareOfSteps * kLooseTolerance / ReferenceOrbit::kCaution;
  constexpr double kLeftBySweeps = 1e-5;
  MarchStatistics statistics;
  long marched_cycles = 0;
  OrbitSolver solver(system, contacts, statistics, marched_cycles, kCoefficient);
  OrbitRequest precise = request;
  precise.tolerance = kLeftBySweeps;
  PeriodicOrbit orbit = origin;
  std::vector<ReferenceOrbit> out;
  GridComparison comparison(system.mesh().intervals());
  const StepSequence sequence(system.mesh().intervals(), least);
  for (int steps = sequence.first(); out.size() < kMostGrids && steps <= kMostSteps;
       steps = sequence.after(steps, 1)) {
    const MeshGrid& grid = grids.with_steps(steps);
    if (out.empty() && !solver.approach_without_friction(grid, precise, orbit)) break;
    precise.first_cycles = 0;
    if (!solver.solve(grid, precise, orbit)) break;
    const double error = out.empty() ? 0 : comparison.error(steps, orbit.figures) + orbit.unsettled;
    comparison.add(steps, orbit.figures, error);
    out.push_back({steps, orbit, error});
    // A lubricant's friction is yet to come.
    out.back().orbit.least_response =
        kShareOfResponse * std::exchange(out.back().orbit.response, 0);
    out.back().orbit.contacts.reset();
    const bool parts = request.keep_contact && orbit.least_pressing_force < -kClearPull;
    if (parts || (out.size() > 1 && error < kSmall)) break;
  }
  system.take_refusal();
  if (out.size() == 1) out.front().step_error = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < out.size(); ++i) {
    out[i].step_error =
        out.back().step_error + out[i].orbit.figures.distance(out.back().orbit.figures);
  }
  const auto finer = [&](std::size_t i) {
    return static_cast<double>(out[i].steps) / out[i - 1].steps;
  };
  if (out.size() > 1 && out[0].step_error < finer(1) * finer(1) * out[1].step_error) {
    OrbitSolver other(system, contacts, statistics, marched_cycles, kOtherCoefficient);
    out[0].step_error = std::max(
        out[0].step_error, error_by_other_friction(other, grids, precise, out[0], out.back()));
    system.take_refusal();
  }
  // Less than the second power of the steps tells may be an accident of one friction.
  for (std::size_t i = 1; i + 1 < out.size(); ++i) {
    out[i].step_error =
        std::max(out[i].step_error, out[i - 1].step_error / (2 * finer(i) * finer(i)));
  }
  return out;
}

const std::vector<ReferenceOrbit>& ReferenceOrbits::find(GearPairSystem& system,
                                                         const FlankContactBatch& contacts,
                                                         MeshGrids& grids,
                                                         const OrbitRequest& request,
                                                         const PeriodicOrbit& origin, int least) {
  Key key{static_cast<double>(least),
          static_cast<double>(request.keep_contact),
          static_cast<double>(request.first_cycles),
          static_cast<double>(request.solve_wheel_torque),
          static_cast<double>(origin.period),
          request.mean_pinion_speed,
          origin.torques.pinion,
          origin.torques.wheel};
  std::copy(origin.state.begin(), origin.state.end(), key.begin() + 8);
  if (const auto known = found_.find(key); known != found_.end()) return known->second;
  if (steps_kept_ > kMostStepsKept) {
    found_.clear();
    steps_kept_ = 0;
  }
  const Torques torques = system.torques();
  auto made = reference_orbits(system, contacts, grids, request, origin, least);
  system.set_torques(torques);
  for (const ReferenceOrbit& each : made) steps_kept_ += each.steps;
  return found_.emplace(key, std::move(made)).first->second;
}

}  // namespace tribodyn
