#include "core/study/orbit_refinement.h"

#include <algorithm>
#include <cmath>

namespace tribodyn {
namespace {

constexpr double kSafety = 2.5;    // on the error that two step lengths tell
constexpr double kRepels = 0.994;  // multipliers under lagged friction are good to 3e-3
constexpr int kFewCycles = 12;     // before shooting at a response with contact loss
constexpr double kLoose = 3e-4;    // tolerance of which few steps may do
constexpr int kFinest = 4000;      // steps per mesh cycle

double square(double x) { return x * x; }

/// Oscillations of the mesh on its mean stiffness in a mesh cycle.
double mesh_oscillations(const GearPairSystem& system, double mean_pinion_speed) {
  const MeshData& mesh = system.mesh();
  const DrivelineDynamics& d = system.dynamics();
  const double compliance = square(mesh.mean_pinion_contact_radius()) / d.pinion_inertia +
                            square(mesh.mean_gear_contact_radius()) / d.gear_inertia;
  return std::sqrt(mesh.mean_mesh_stiffness() * compliance) /
         (mean_pinion_speed * mesh.pinion_teeth());
}

/// Numbers of steps per mesh cycle. The first end on samples of the tables and the second do not:
/// else both would see the kinks there in the same way and agree on the same error. In the end no
/// step has a kink inside.
class StepSequence {
 public:
  StepSequence(int intervals, int least) : intervals_(intervals), coarsest_(intervals) {
    while (coarsest_ % 2 == 0 && coarsest_ / 2 >= least) coarsest_ /= 2;
    while (coarsest_ < least) coarsest_ *= 2;
  }
  int first() const { return coarsest_; }
  int after(int steps) const {
    if (steps == coarsest_) return coarsest_ * 5 / 3;
    if (steps % intervals_ == 0 || 4 * steps < intervals_) return 2 * steps;
    int next = intervals_;
    while (next < 2 * steps) next *= 2;
    return next;
  }

 private:
  int intervals_, coarsest_;
};

}  // namespace

std::optional<RefinedOrbit> refine_orbit(GearPairSystem& system, const FlankContactBatch& contacts,
                                         MeshGrids& grids, const OrbitSearch& search,
                                         MarchStatistics& statistics, long& marched_cycles) {
  OrbitRequest request;
  request.mean_pinion_speed = search.mean_pinion_speed;
  request.solve_wheel_torque = search.solve_wheel_torque;
  request.interrupted = search.interrupted;
  request.keep_contact = search.try_contact_first;

  PeriodicOrbit origin;
  origin.state = search.start;
  origin.torques = system.torques();
  origin.period = search.period;

  RefinedOrbit best;
  bool have_coarser = false;
  double halving_difference = 0;
  double doubtful_pull = kClearPull;  // of the mean force: as little may be the steps' error
  // Seven steps for an oscillation tell its height to some percent; fewer tell nothing.
  const double least =
      std::max(7 * mesh_oscillations(system, search.mean_pinion_speed),
               search.tolerance < kLoose || !search.try_contact_first ? 24.0 : 12.0);
  if (least > kFinest) return std::nullopt;
  const StepSequence sequence(system.mesh().intervals(), static_cast<int>(least));
  for (int steps = sequence.first(); steps <= kFinest; steps = sequence.after(steps)) {
    const MeshGrid& grid = grids.with_steps(steps);
    // Sweeps go on until what they leave is well below what the step length can give.
    request.tolerance = have_coarser ? 0.2 * search.tolerance : std::max(5 * search.tolerance, 1e-4);
    PeriodicOrbit orbit = have_coarser ? best.orbit : origin;
    const auto solve = [&] {
      return solve_periodic_orbit(system, contacts, grid, request, orbit, statistics,
                                  marched_cycles);
    };
    bool found = false;
    if (request.keep_contact) {
      request.first_cycles = 0;
      found = solve() && !(orbit.least_pressing_force < -doubtful_pull);
      if (!found) {
        if (system.take_refusal() != ContactStatus::kOk) return std::nullopt;
        // Flanks would have to pull: contact is lost, and the start decides how.
        request.keep_contact = false;
        have_coarser = false;
      }
      doubtful_pull /= 4;
    }
    if (!request.keep_contact) {
      // Newton's method leads to the response that is near; others are found by patience.
      for (const int cycles : {kFewCycles, search.first_cycles}) {
        request.first_cycles = have_coarser ? 0 : cycles;
        if (!have_coarser) orbit = origin;
        found = solve();
        if (found || have_coarser) break;
      }
    }
    if (!found) {
      if (system.take_refusal() != ContactStatus::kOk) return std::nullopt;
      have_coarser = false;
      continue;
    }
    double estimate = 0;
    if (have_coarser) {
      const double difference = orbit.figures.distance(best.orbit.figures);
      // Second order at kinks and events; more only where two halvings have shown it.
      const double finer = static_cast<double>(steps) / best.steps_per_mesh_cycle;
      double gain = square(finer);
      const bool halving = steps == 2 * best.steps_per_mesh_cycle;
      if (halving && halving_difference > 0) {
        gain = std::clamp(halving_difference / std::max(difference, 1e-300), 2.5, 4.0);
      }
      // Two step lengths may agree by accident, three rarely do.
      const double step_error = std::max(kSafety * difference / (gain - 1),
                                         best.estimated_error / (2 * square(finer)));
      estimate = step_error + orbit.unsettled;
      halving_difference = halving ? difference : 0;
    }
    best = {std::move(orbit), steps, estimate, 0};
    const bool pulls = request.keep_contact && best.orbit.least_pressing_force < 0;
    if (have_coarser && estimate <= search.tolerance && !pulls) {
      best.largest_multiplier = best.orbit.map->largest_multiplier();
      if (!(best.largest_multiplier < kRepels)) return std::nullopt;
      return best;
    }
    have_coarser = true;
  }
  return std::nullopt;
}

}  // namespace tribodyn
