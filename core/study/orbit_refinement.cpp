#include "core/study/orbit_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/dynamics/orbit_solver.h"
#include "core/dynamics/steady_state.h"
#include "core/dynamics/tapping_start.h"
#include "core/numerics/square.h"
#include "core/refusal.h"
#include "core/study/grid_comparison.h"
#include "core/study/step_sequence.h"

namespace tribodyn {
namespace {

constexpr double kSweepShare = 0.4;  // of the tolerance: may be left by sweeps
constexpr int kPatience = 300;       // periods
constexpr double kNearDoubling = 0.06;
constexpr double kLittlePull = 0.2;     // of the mean force
constexpr double kMarchedDoubt = 1e-4;  // about multipliers by the march
constexpr int kMostFailures = 3;
constexpr int kTapSteps = 40;            // of a mesh cycle: a tap lasts for some percent of it
constexpr int kStepsPerOscillation = 7;  // show its height to some percent; fewer show nothing

/// Multipliers under lagged friction are good to 3e-3, and better where a period is short: what
/// comes nearer to 1 may repel.
double margin(const GearPairSystem& system, const OrbitSearch& search) {
  constexpr double kDecay = 3.4;  // [1/s]
  const double period = search.period * system.cycle_angle() / search.mean_pinion_speed;
  return std::min(0.006, kDecay * period);
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

/// The search for one response, on one grid after another or on that which references tell.
class Refinement {
 public:
  /// `cycles_left`: to march in search of a response; charged also where one is known already, so
  /// that answers do not depend on that. Keeps the references.
  Refinement(GearPairSystem& system, const FlankContactBatch& contacts, OrbitSolver& solver,
             MeshGrids& grids, const OrbitSearch& search, MarchStatistics& statistics,
             long& marched_cycles, int& cycles_left)
      : system_(system),
        contacts_(contacts),
        solver_(solver),
        grids_(grids),
        search_(search),
        statistics_(statistics),
        marched_cycles_(marched_cycles),
        cycles_left_(cycles_left),
        coarser_(system.mesh().intervals()) {
    request_.mean_pinion_speed = search.mean_pinion_speed;
    request_.solve_wheel_torque = search.solve_wheel_torque;
    request_.interrupted = search.interrupted;
    request_.renew_friction = search.renew_friction;
    request_.keep_contact = search.try_contact_first;
    request_.share_of_change = 0.3;
    origin_.state = search.start;
    origin_.torques = system.torques();
    origin_.period = search.period;
  }

  std::optional<RefinedOrbit> run() {
    const double least =
        std::max(kStepsPerOscillation * mesh_oscillations(system_, search_.mean_pinion_speed),
                 search_.tolerance < kLooseTolerance || !search_.try_contact_first ? 24.0 : 12.0);
    if (least > kMostSteps) return std::nullopt;
    if (search_.references != nullptr && search_.tolerance >= kLooseTolerance) {
      if (auto found = find_by_reference(static_cast<int>(least))) return found;
      if (is_over_) return std::nullopt;
      repels_ = doubles_ = false;
      marched_multiplier_.reset();
    }
    const StepSequence sequence(system_.mesh().intervals(), static_cast<int>(least));
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    double excess = kUnknown;
    for (int steps = sequence.first(); steps <= kMostSteps && !is_over_;
         steps = sequence.after(steps, excess)) {
      const MeshGrid& grid = grids_.with_steps(steps);
      excess = kUnknown;
      if (!find(grid)) continue;
      const bool is_compared = coarser_.is_possible();
      const double error = is_compared ? step_error(grid) + orbit_.unsettled : 0;
      if (is_compared) excess = error / search_.tolerance;
      const bool pulls = request_.keep_contact && orbit_.least_pressing_force < 0;
      if (is_compared && error <= search_.tolerance && !pulls) {
        if (!attracts(grid)) return std::nullopt;
        return RefinedOrbit{std::move(orbit_), steps, marched_multiplier_, error};
      }
      coarser_.add(steps, orbit_.figures, error);
    }
    return std::nullopt;
  }

  /// A response was found that surely repels, or may, where periods double.
  bool repels() const { return repels_; }
  /// To both sides in turn: where a doubled response is near.
  bool doubles() const { return doubles_; }

  const Torques& torques() const { return orbit_.torques; }

  /// Beside the one that repels, off to where it repels to: by half of the mean deflection of the
  /// mesh; nearer, hundreds of cycles may lead back to it. Where flanks stay together, by enough to
  /// part them: until then the motion is linear, and leaves no faster than the multiplier says.
  MarchState beside_repelling() const {
    const double off = orbit_.contact_loss ? 0.5 : 1.2;
    const MarchScales scales = march_scales(system_, search_.mean_pinion_speed);
    const auto direction = orbit_.map->alternating_disturbance();
    const double share = off / std::max(std::abs(direction(kWinding - 1)), 0.5);
    MarchState out = orbit_.pieces.front().start;
    for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
      out[i] += share * direction(i - 1) * scales.of(system_.mesh(), i);
    }
    return out;
  }

 private:
  double step_error(const MeshGrid& grid) const {
    return coarser_.error(grid.steps(), orbit_.figures);
  }

  /// On one grid, the steps' error on which is known from the same response under Coulomb's
  /// friction. Nothing where that cannot tell.
  std::optional<RefinedOrbit> find_by_reference(int least) {
    const bool in_contact = request_.keep_contact;
    if (request_.keep_contact) {
      const auto& references = references_now(least);
      if (references.empty()) return std::nullopt;
      if (references.front().orbit.least_pressing_force >= 0) return settle_from(references);
      if (references.front().orbit.least_pressing_force > -kLittlePull) return std::nullopt;
      request_.keep_contact = false;
    }
    cycles_left_ -= search_.few_cycles * search_.period;
    request_.first_cycles = search_.few_cycles;
    std::optional<RefinedOrbit> found;
    if (cycles_left_ >= 0) found = settle_from(references_now(least));
    request_.keep_contact = in_contact;
    request_.first_cycles = 0;
    return found;
  }

  const std::vector<ReferenceOrbit>& references_now(int least) {
    return search_.references->find(system_, contacts_, grids_, request_, origin_, least);
  }

  /// From the first of them whose steps are short enough.
  std::optional<RefinedOrbit> settle_from(const std::vector<ReferenceOrbit>& references) {
    const auto fits = std::find_if(references.begin(), references.end(), [&](const auto& each) {
      return each.doubt() <= kShareOfSteps * search_.tolerance;
    });
    if (fits == references.end()) return std::nullopt;
    const MeshGrid& grid = grids_.with_steps(fits->steps);
    // What is asked of the map here is known to all that start from it.
    fits->orbit.map->distance_from_doubling();
    fits->orbit.map->multipliers_are_below(1 - margin(system_, search_));
    orbit_ = fits->orbit;
    request_.tolerance = search_.tolerance - fits->doubt();
    if (!solver_.solve(grid, request_, orbit_)) {
      is_over_ = system_.take_refusal() != ContactStatus::kOk;
      return std::nullopt;
    }
    const bool is_alike = request_.keep_contact ? orbit_.least_pressing_force >= 0
                                                : orbit_.contact_loss && fits->orbit.contact_loss;
    if (!is_alike || !attracts(grid)) return std::nullopt;
    const double error = fits->doubt() + orbit_.unsettled;
    return RefinedOrbit{std::move(orbit_), fits->steps, marched_multiplier_, error};
  }

  /// The response on a grid. False where there is none on it; over where none is to be expected.
  bool find(const MeshGrid& grid) {
    // The error is shared between the steps and what sweeps leave.
    request_.tolerance = coarser_.is_possible() ? kSweepShare * search_.tolerance
                                                : std::max(5 * search_.tolerance, 1e-4);
    bool found = request_.keep_contact && find_in_contact(grid);
    if (is_over_) return false;
    if (is_tapping_ && !coarser_.is_possible()) {
      if (grid.steps() < kTapSteps) return false;
      start_tapping(grid);
    }
    if (!found) found = find_anywhere(grid);
    if (is_over_) return false;
    if (found && coarser_.is_possible()) found = sweep_on(grid);
    if (found) return true;
    is_over_ = system_.take_refusal() != ContactStatus::kOk || !search_.patient ||
               ++failures_ == kMostFailures;
    coarser_.clear();
    return false;
  }

  /// Flanks kept together. Where they would have to pull, contact is lost from then on: where they
  /// pull a little, by a response near this one if there is any; or else the start decides how.
  bool find_in_contact(const MeshGrid& grid) {
    request_.first_cycles = 0;
    const bool solved = solve(grid);
    if (solved && !(orbit_.least_pressing_force < -doubtful_pull_)) {
      doubtful_pull_ /= 4;
      return true;
    }
    is_over_ = system_.take_refusal() != ContactStatus::kOk;
    request_.keep_contact = false;
    orbit_.moved_from_map = std::numeric_limits<double>::infinity();  // it knows no gap
    coarser_.clear();
    if (is_over_) return false;
    if (solved && orbit_.least_pressing_force >= -kLittlePull) {
      if (solver_.solve(grid, request_, orbit_)) return true;
      is_over_ = system_.take_refusal() != ContactStatus::kOk;
      if (is_over_) return false;
    }
    start_tapping(grid);
    return false;
  }

  /// From where flanks tap each other, if the load is so light that they must: from the static
  /// equilibrium they are thrown far into the backlash, and so light a load takes hundreds of mesh
  /// cycles to bring them back.
  void start_tapping(const MeshGrid& grid) {
    system_.set_torques(origin_.torques);
    const auto start = tapping_start(system_, grid, search_.mean_pinion_speed);
    if (!start) return;
    origin_.state = *start;
    is_tapping_ = true;
  }

  /// Newton's method leads to the response that is near, if need be on another grid; others are
  /// found by patience.
  bool find_anywhere(const MeshGrid& grid) {
    const bool is_last = failures_ + 1 == kMostFailures;
    for (const int cycles : {is_tapping_ ? 0 : search_.few_cycles, search_.first_cycles}) {
      if (!coarser_.is_possible()) cycles_left_ -= cycles * search_.period;
      if (cycles_left_ < 0) {
        system_.take_refusal();
        is_over_ = true;
        return false;
      }
      request_.first_cycles = cycles;
      if (solve(grid)) return true;
      if (coarser_.is_possible() || search_.few_cycles == search_.first_cycles) break;
      if (search_.few_cycles == 0 && !is_last) break;
    }
    return false;
  }

  /// From the coarser grid's response, or without friction from the start.
  bool solve(const MeshGrid& grid) {
    if (!coarser_.is_possible()) {
      const bool is_near = !request_.keep_contact && request_.first_cycles == 0;
      orbit_ = origin_;
      const bool good = is_near ? solver_.approach_from_near(grid, request_, orbit_)
                                : solver_.approach_without_friction(grid, request_, orbit_);
      if (!good) return false;
    }
    return solver_.solve(grid, request_, orbit_);
  }

  /// Where only sweeps are missing, they are cheaper than another grid.
  bool sweep_on(const MeshGrid& grid) {
    const double left = search_.tolerance - step_error(grid);
    if (!(left > 0) || orbit_.unsettled <= left) return true;
    OrbitRequest more = request_;
    more.tolerance = left;
    more.share_of_change = 0;
    return solver_.solve(grid, more, orbit_);
  }

  /// Whether the response surely does.
  bool attracts(const MeshGrid& grid) {
    // A map from near may know nothing of a flank that hardly parts, nor of what friction does to
    // the multipliers: 0.02 where periods double.
    const bool doubles = orbit_.map->distance_from_doubling() < kNearDoubling;
    if ((orbit_.contact_loss || doubles) && !solver_.renew_map(grid, request_, orbit_)) {
      return false;
    }
    double doubt = margin(system_, search_);
    if (orbit_.map->multipliers_are_below(1 - doubt)) return true;
    double multiplier = orbit_.map->largest_multiplier();
    if (std::abs(multiplier - 1) <= doubt) {
      if (!march_multiplier()) return false;
      multiplier = *marched_multiplier_;
      doubt = kMarchedDoubt;
    }
    if (multiplier < 1 - doubt) return true;
    // In doubt whether the period has doubled, it is looked for.
    doubles_ = doubles || (multiplier > 1 + doubt && orbit_.map->alternates());
    repels_ = doubles_ || (multiplier > 1 + doubt && orbit_.period > 1);
    return false;
  }

  bool march_multiplier() {
    SteadyStateRequest request;
    request.mean_pinion_speed = search_.mean_pinion_speed;
    request.solve_wheel_torque = search_.solve_wheel_torque;
    request.march.relative_tolerance = 1e-8;
    request.march.interrupted = search_.interrupted;
    system_.set_torques(orbit_.torques);
    system_.solve_together(&contacts_);
    try {
      marched_multiplier_ = marched_multiplier(system_, orbit_.pieces.front().start, orbit_.period,
                                               request, statistics_, marched_cycles_);
    } catch (const Refusal&) {
      system_.take_refusal();
    }
    system_.solve_together(nullptr);
    return marched_multiplier_.has_value();
  }

  GearPairSystem& system_;
  const FlankContactBatch& contacts_;
  OrbitSolver& solver_;
  MeshGrids& grids_;
  const OrbitSearch& search_;
  MarchStatistics& statistics_;
  long& marched_cycles_;
  int& cycles_left_;
  OrbitRequest request_;
  PeriodicOrbit origin_, orbit_;
  GridComparison coarser_;
  int failures_ = 0;
  double doubtful_pull_ = kClearPull;  // of the mean force: as little may be the steps' error
  bool is_tapping_ = false;            // at the start
  bool is_over_ = false, repels_ = false, doubles_ = false;
  std::optional<double> marched_multiplier_;
};

}  // namespace

double mesh_oscillations(const GearPairSystem& system, double mean_pinion_speed) {
  const MeshData& mesh = system.mesh();
  const DrivelineDynamics& d = system.dynamics();
  const double compliance = square(mesh.mean_pinion_contact_radius()) / d.pinion_inertia +
                            square(mesh.mean_gear_contact_radius()) / d.gear_inertia;
  return std::sqrt(mesh.mean_mesh_stiffness() * compliance) /
         (mean_pinion_speed * mesh.pinion_teeth());
}

bool oscillates_too_often(double mesh_oscillations) {
  return kStepsPerOscillation * mesh_oscillations > kMostSteps;
}

std::optional<RefinedOrbit> refine_orbit(GearPairSystem& system, const FlankContactBatch& contacts,
                                         MeshGrids& grids, const OrbitSearch& search,
                                         MarchStatistics& statistics, long& marched_cycles,
                                         std::optional<Rattle>& rattle) {
  constexpr int kLongestPeriod = 4;
  OrbitSearch next = search;
  int cycles_left = search.maximum_mesh_cycles;
  OrbitSolver solver(system, contacts, statistics, marched_cycles);
  const Torques torques = system.torques();
  std::optional<Rattle> beside;
  for (bool patient = false;; patient = true) {
    system.set_torques(torques);
    const auto refinement_now = [&] {
      return Refinement(system, contacts, solver, grids, next, statistics, marched_cycles,
                        cycles_left);
    };
    Refinement refinement = refinement_now();
    auto found = refinement.run();
    const bool repels = refinement.repels();
    while (found && next.period % 2 == 0 && is_half_as_long(system, search, found->orbit)) {
      next.period /= 2;
      next.start = found->orbit.state;
      next.few_cycles = next.first_cycles = 1;
      auto shorter = refinement_now().run();
      if (!shorter) break;
      found = std::move(shorter);
    }
    if (found) return found;
    // A doubled response that repels too, and a longer one that does as well or is not there after
    // hundreds of cycles: none repeats.
    if (repels && next.period > 1) rattle = beside;
    if ((patient && !repels) || 2 * next.period > kLongestPeriod) return found;
    if (!search.patient) return found;
    // Periods double where a response begins to repel, and a branch may end between neighbours: to
    // what follows patience leads.
    if (repels) {
      next.period *= 2;
      if (refinement.doubles()) {
        next.start = refinement.beside_repelling();
        beside = {next.start, refinement.torques()};
      }
    }
    if (!repels && search.try_contact_first) return found;
    next.try_contact_first = false;
    next.few_cycles = next.first_cycles = kPatience;
    next.renew_friction = true;
    next.references = nullptr;
  }
}

}  // namespace tribodyn
