#include "core/study/orbit_refinement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/dynamics/orbit_solver.h"
#include "core/study/step_sequence.h"

namespace tribodyn {
namespace {

constexpr double kSafety = 1.7;      // on the error that two step lengths tell
constexpr double kSweepShare = 0.4;  // of the tolerance: may be left by sweeps
constexpr int kPatience = 300;       // periods
constexpr double kNearDoubling = 0.06;
constexpr int kMostFailures = 3;
constexpr double kLoose = 3e-4;  // tolerance of which few steps may do
constexpr int kFinest = 4000;    // steps per mesh cycle

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

/// Multipliers under lagged friction are good to 3e-3, and better where a period is short: what
/// comes nearer to 1 may repel.
double margin(const GearPairSystem& system, const OrbitSearch& search) {
  constexpr double kDecay = 3.4;  // [1/s]
  const double period = search.period * system.cycle_angle() / search.mean_pinion_speed;
  return std::min(0.006, kDecay * period);
}

/// What kinks of the tables inside of steps may do where two step lengths agree by accident: by
/// experience half of it.
double kink_error(int steps, int intervals) {
  return steps % intervals == 0 ? 0 : 0.025 / square(steps);
}

/// Of the figures on steps that are `finer` times shorter than those before, and what that changed.
/// `halving_difference`: what two halvings ago did, 0: there were none.
double step_error_of(double difference, double finer, double halving_difference,
                     double coarser_error) {
  // Second order at kinks and events; more only where two halvings have shown it.
  double gain = square(finer);
  if (finer == 2 && halving_difference > 0) {
    gain = std::clamp(halving_difference / std::max(difference, 1e-300), 2.5, 8.0);
  }
  // Two step lengths may agree by accident, three rarely do.
  return std::max(kSafety * difference / (gain - 1), coarser_error / (2 * square(finer)));
}

/// Whether the state at half of the period is that at its start.
bool is_half_as_long(const GearPairSystem& system, const OrbitSearch& search,
                     const PeriodicOrbit& orbit) {
  const auto half = std::find_if(orbit.pieces.begin(), orbit.pieces.end(), [&](const auto& piece) {
    return piece.phase >= 0.5 * orbit.period - 1e-9;
  });
  const MarchScales scales = march_scales(system, search.mean_pinion_speed);
  double difference = 0;
  for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
    difference = std::max(difference, std::abs(half->start[i] - orbit.pieces.front().start[i]) /
                                          scales.of(system.mesh(), i));
  }
  return difference < 1e-3;
}

/// `cycles_left`: to march in search of a response; charged also where one is known already, so
/// that answers do not depend on that. `repels`: set where a response is found that surely does, or
/// may where periods double.
std::optional<RefinedOrbit> refine(GearPairSystem& system, OrbitSolver& solver, MeshGrids& grids,
                                   const OrbitSearch& search, int& cycles_left, bool& repels) {
  OrbitRequest request;
  request.mean_pinion_speed = search.mean_pinion_speed;
  request.solve_wheel_torque = search.solve_wheel_torque;
  request.interrupted = search.interrupted;
  request.renew_friction = search.renew_friction;
  request.keep_contact = search.try_contact_first;

  PeriodicOrbit origin;
  origin.state = search.start;
  origin.torques = system.torques();
  origin.period = search.period;

  RefinedOrbit best;
  bool have_coarser = false;
  int failures = 0;
  double halving_difference = 0;
  double doubtful_pull = kClearPull;  // of the mean force: as little may be the steps' error
  // Seven steps for an oscillation tell its height to some percent; fewer tell nothing.
  const double least =
      std::max(7 * mesh_oscillations(system, search.mean_pinion_speed),
               search.tolerance < kLoose || !search.try_contact_first ? 24.0 : 12.0);
  if (least > kFinest) return std::nullopt;
  const StepSequence sequence(system.mesh().intervals(), static_cast<int>(least));
  for (int steps = sequence.first(); steps <= kFinest;
       steps = sequence.after(steps, best.estimated_error / search.tolerance)) {
    const MeshGrid& grid = grids.with_steps(steps);
    // The error is shared between the steps and what sweeps leave.
    request.tolerance =
        have_coarser ? kSweepShare * search.tolerance : std::max(5 * search.tolerance, 1e-4);
    const OrbitFigures coarser = best.orbit.figures;
    PeriodicOrbit orbit = have_coarser ? std::move(best.orbit) : origin;
    const auto solve = [&] {
      if (!have_coarser) {
        const auto approach = [&] {
          orbit = origin;
          return solver.approach_without_friction(grid, request, orbit);
        };
        if (search.frictionless == nullptr) {
          if (!approach()) return false;
        } else if (!search.frictionless->find(steps, request, origin, approach, orbit)) {
          return false;
        }
      }
      return solver.solve(grid, request, orbit);
    };
    const double finer = have_coarser ? static_cast<double>(steps) / best.steps_per_mesh_cycle : 0;
    const double kinks = kink_error(steps, system.mesh().intervals());
    bool found = false;
    if (request.keep_contact) {
      request.first_cycles = 0;
      found = solve() && !(orbit.least_pressing_force < -doubtful_pull);
      if (!found) {
        if (system.take_refusal() != ContactStatus::kOk) return std::nullopt;
        // Flanks would have to pull: contact is lost, and the start decides how.
        request.keep_contact = false;
        have_coarser = false;
        halving_difference = 0;
      }
      doubtful_pull /= 4;
    }
    if (!request.keep_contact) {
      // Newton's method leads to the response that is near; others are found by patience.
      for (const int cycles : {search.few_cycles, search.first_cycles}) {
        if (found) break;
        if (!have_coarser) cycles_left -= cycles * search.period;
        if (cycles_left < 0) {
          system.take_refusal();
          return std::nullopt;
        }
        request.first_cycles = cycles;
        found = solve();
        if (have_coarser || search.few_cycles == search.first_cycles) break;
      }
    }
    double step_error = 0;
    const auto judge = [&] {
      step_error = std::max(step_error_of(orbit.figures.distance(coarser), finer,
                                          halving_difference, best.estimated_error),
                            kinks);
      return search.tolerance - step_error;  // left for sweeps
    };
    if (found && have_coarser) {
      const double left = judge();
      // They are cheaper than another grid.
      if (left > 0 && orbit.unsettled > left) {
        request.tolerance = left;
        found = solver.solve(grid, request, orbit);
        judge();
      }
    }
    if (!found) {
      if (system.take_refusal() != ContactStatus::kOk || !search.patient ||
          ++failures == kMostFailures) {
        return std::nullopt;
      }
      have_coarser = false;
      halving_difference = 0;
      continue;
    }
    const double estimate = have_coarser ? step_error + orbit.unsettled : 0;
    halving_difference = have_coarser && finer == 2 ? orbit.figures.distance(coarser) : 0;
    best = {std::move(orbit), steps, estimate};
    const bool pulls = request.keep_contact && best.orbit.least_pressing_force < 0;
    if (have_coarser && estimate <= search.tolerance && !pulls) {
      // A map from near may know nothing of a flank that hardly parts, nor of what friction does
      // to the multipliers: 0.02 where periods double.
      const bool doubles = best.orbit.map->distance_from_doubling() < kNearDoubling;
      if ((best.orbit.contact_loss || doubles) && !solver.renew_map(grid, request, best.orbit)) {
        return std::nullopt;
      }
      const double doubt = margin(system, search);
      if (best.orbit.map->multipliers_are_below(1 - doubt)) return best;
      const double multiplier = best.orbit.map->largest_multiplier();
      if (multiplier < 1 - doubt) return best;
      // In doubt whether the period has doubled, it is looked for.
      repels = multiplier > 1 + doubt || (doubles && multiplier > 1 - doubt);
      return std::nullopt;
    }
    have_coarser = true;
  }
  return std::nullopt;
}

}  // namespace

std::optional<RefinedOrbit> refine_orbit(GearPairSystem& system, const FlankContactBatch& contacts,
                                         MeshGrids& grids, const OrbitSearch& search,
                                         MarchStatistics& statistics, long& marched_cycles) {
  constexpr int kLongestPeriod = 4;
  OrbitSearch next = search;
  int cycles_left = search.maximum_mesh_cycles;
  OrbitSolver solver(system, contacts, statistics, marched_cycles);
  const Torques torques = system.torques();
  for (bool patient = false;; patient = true) {
    bool repels = false;
    system.set_torques(torques);
    auto found = refine(system, solver, grids, next, cycles_left, repels);
    if (found && next.period > search.period && is_half_as_long(system, search, found->orbit)) {
      next.period /= 2;
      next.start = found->orbit.state;
      next.few_cycles = next.first_cycles = 1;
      found = refine(system, solver, grids, next, cycles_left, repels);
    }
    if (found || (patient && !repels) || 2 * next.period > kLongestPeriod) return found;
    if (!search.patient) return found;
    // Periods double where a response begins to repel, and a branch may end between neighbours: to
    // what follows patience leads.
    if (repels) next.period *= 2;
    if (!repels && search.try_contact_first) return found;
    next.try_contact_first = false;
    next.few_cycles = next.first_cycles = kPatience;
    next.renew_friction = true;
    next.frictionless = nullptr;
  }
}

}  // namespace tribodyn
