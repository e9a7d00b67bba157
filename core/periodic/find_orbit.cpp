#include "core/periodic/find_orbit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/periodic/grid_convergence.h"
#include "core/periodic/orbit_sensitivity.h"
#include "core/periodic/orbit_solver.h"
#include "core/periodic/steady_state.h"
#include "core/periodic/tapping_start.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

// Random scenes and sweeps: see "How tuning constants were found" in core/README.md.

// Share of the tolerance for the Picard error. Not critical: with 0.2 random scenes take 0.2 % more
// work, with 0.8 0.1 % less.
constexpr double kPicardShare = 0.4;
// Periods integrated where the transient decides. With 100 two more random scenes are marched and
// do not settle; with 600 all take 1.8 times the work.
constexpr int kTransientPeriods = 300;
// Distance of a multiplier from -1 below which its Jacobian is computed anew: three times the shift
// by friction (0.02). A caution: with 0 and 0.2 random scenes and sweeps come out the same.
constexpr double kSmallFlipMargin = 0.06;
// Tension over the mean force under which the orbit with contact loss is sought near this one. Not
// critical: with 0.05 and 0.8 the same orbits, for 0.1 % more work.
constexpr double kLittleTension = 0.2;
// Of the mean force: tension on eight steps that more steps may not confirm (a cautious guess).
constexpr double kDoubtOfFewSteps = 0.05;
// About multipliers with friction by derivatives on a grid: at 12 steps they err by 1e-4.
constexpr double kDoubtOfSteps = 5e-4;
constexpr double kMarchedDoubt = 1e-4;  // about multipliers by the march: see steady_state.h
// Grids without an orbit that end the search; a lost orbit counts twice. With 2 random scenes take
// 4 % more work, with 6 the sweep down by 10 km/h five times its contacts.
constexpr int kMostFailures = 3;
// Of a mesh cycle: a tap lasts for some percent of it. Not critical: with 20 and 80 the light
// points of core/README.md take 2 % and 0.5 % more work.
constexpr int kTapSteps = 40;
constexpr int kStepsPerOscillation = 7;  // show its height to some percent
// From this tolerance on fewer steps are enough for the first grid: at 1e-2 the estimates of 550
// random smooth scenes were bounds, at 3e-3 one was not.
constexpr double kToleranceOfFewSteps = 5e-3;
constexpr int kFewStepsPerOscillation = 5;

/// Half-width of the interval around 1 in which a multiplier under frozen friction does not decide
/// whether the orbit attracts: multipliers are good to 3e-3, and better if the period is short.
/// Neither number is critical: random scenes come out the same with half and twice of both, and the
/// sweeps but for one end that moves by 0.04 km/h at a decay of 1.7 1/s.
double margin(const PeriodicProblem& problem, int period_in_cycles) {
  constexpr double kDecay = 3.4;  // [1/s]
  const double period = period_in_cycles * problem.system.cycle_angle() / problem.mean_pinion_speed;
  return std::min(0.006, kDecay * period);
}

/// Whether the state at half of the period is that at its start.
bool is_half_as_long(const PeriodicProblem& problem, const PeriodicOrbit& orbit) {
  const auto half = std::find_if(orbit.pieces.begin(), orbit.pieces.end(), [&](const auto& piece) {
    return piece.phase >= 0.5 * orbit.period - 1e-9;
  });
  const MarchScales scales = march_scales(problem.system, orbit.torques, problem.mean_pinion_speed);
  double difference = 0;
  for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
    difference = std::max(difference, std::abs(half->start[i] - orbit.pieces.front().start[i]) /
                                          scales.of(problem.system.mesh(), i));
  }
  return difference < 1e-3;
}

/// The search for one orbit: on one grid after another, or on the grid whose error the orbits under
/// Coulomb's friction give.
class GridRefinement {
 public:
  /// `cycles_left`: mesh cycles that may be integrated; reduced also where an orbit is known
  /// already, so that results do not depend on the cache. Keeps the references.
  GridRefinement(const PeriodicProblem& problem, const OrbitSearch& search, const Torques& torques,
                 OrbitSolver& solver, SolverWork& work, int& cycles_left)
      : problem_(problem),
        system_(problem.system),
        search_(search),
        solver_(solver),
        work_(work),
        cycles_left_(cycles_left),
        coarser_(problem) {
    options_.renew_friction = search.renew_friction;
    options_.bilateral_contact = search.try_contact_first;
    // Not critical: with 0 and 0.6 random scenes take less than 0.1 % more work.
    options_.share_of_change = 0.3;
    origin_.state = search.start;
    origin_.torques = torques;
    origin_.period = search.period;
  }

  std::optional<PeriodicOrbit> refine() {
    const double of_oscillations =
        (problem_.tolerance >= kToleranceOfFewSteps && search_.coulomb_orbits == nullptr
             ? kFewStepsPerOscillation
             : kStepsPerOscillation) *
        mesh_oscillations(system_, problem_.mean_pinion_speed);
    if (of_oscillations > kMostStepsPerCycle) return std::nullopt;
    const int of_orders = least_steps_for_orders(problem_);
    const auto steps_from = [&](int fewest) {
      return std::max({static_cast<int>(of_oscillations), of_orders, fewest});
    };
    const bool loose = problem_.tolerance >= kLooseTolerance && search_.try_contact_first;
    least_ = steps_from(loose ? 12 : 24);
    if (search_.coulomb_orbits != nullptr && problem_.tolerance >= kLooseTolerance) {
      if (auto found = solve_from_coulomb_orbit(least_)) return found;
      if (is_over_) return std::nullopt;
      repels_ = doubles_ = false;
    }
    const bool very_loose =
        loose && problem_.tolerance >= kVeryLooseTolerance && search_.coulomb_orbits == nullptr;
    const int intervals = system_.mesh().intervals();
    StepSequence sequence(intervals, very_loose ? steps_from(8) : least_);
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    double excess = kUnknown;
    const auto after = [&](int steps) {
      if (!is_in_tension_ || steps >= least_) return sequence.after(steps, excess);
      sequence = StepSequence(intervals, least_);
      return sequence.first();
    };
    for (int steps = sequence.first(); steps <= kMostStepsPerCycle && !is_over_;
         steps = after(steps)) {
      const MeshGrid& grid = problem_.grids.with_steps(steps);
      excess = kUnknown;
      if (!solve_on_grid(grid)) continue;
      const bool is_compared = coarser_.is_possible();
      const double error = is_compared ? step_error(grid) + orbit_.picard_error : 0;
      if (is_compared) excess = error / problem_.tolerance;
      const bool has_tension = options_.bilateral_contact && orbit_.least_pressing_force < 0;
      if (is_compared && error <= problem_.tolerance && !has_tension) {
        if (!attracts(grid)) return std::nullopt;
        orbit_.is_tapping = is_tapping_;
        orbit_.estimated_error = error;
        return std::move(orbit_);
      }
      coarser_.add(steps, orbit_.figures, error);
    }
    return std::nullopt;
  }

  /// Whether an orbit was found that repels, or may repel near a period doubling.
  bool repels() const { return repels_; }
  /// Whether an orbit of twice the period is near.
  bool doubles() const { return doubles_; }

  /// A point beside the orbit that repels, along the eigenvector of the multiplier nearest to -1:
  /// off by half of the mean mesh deflection, because from nearer hundreds of cycles may lead back.
  /// An orbit without contact loss is left by enough to part the flanks: until then the motion is
  /// linear, and leaves no faster than the multiplier. With 0.25 and 1 in place of 0.5 random
  /// scenes and sweeps come out the same; with 0.5 and 2.4 in place of 1.2 one and two more random
  /// scenes are marched.
  SectionPoint beside_repelling() const {
    const double off = orbit_.contact_loss ? 0.5 : 1.2;
    const MarchScales scales = march_scales(system_, orbit_.torques, problem_.mean_pinion_speed);
    const auto direction = orbit_.jacobian->flip_direction();
    const double share = off / std::max(std::abs(direction(kMeshApproach - 1)), 0.5);
    MarchState out = orbit_.pieces.front().start;
    for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
      out[i] += share * direction(i - 1) * scales.of(system_.mesh(), i);
    }
    return system_.at_section(out, orbit_.torques);
  }

 private:
  double step_error(const MeshGrid& grid) const {
    // Flanks that tap each other lose energy in a small part of the mesh cycle, on few steps. The
    // loss errs by up to 2.2 times the estimate from two grids (reference axle, pinion torques from
    // -0.02 to 0.02 N m at 200 and 300 rad/s).
    constexpr double kTapping = 3;
    return (is_tapping_ ? kTapping : 1) * coarser_.error(grid, orbit_.figures);
  }

  /// Solves on the one grid whose error is known from the same orbit under Coulomb's friction.
  /// Returns nullopt if that orbit does not decide.
  std::optional<PeriodicOrbit> solve_from_coulomb_orbit(int least) {
    const bool in_contact = options_.bilateral_contact;
    if (options_.bilateral_contact) {
      const auto& orbits = coulomb_orbits_now(least);
      if (orbits.empty()) return std::nullopt;
      if (orbits.front().least_pressing_force >= 0) return polish_from_coulomb_orbit(orbits);
      if (orbits.front().least_pressing_force > -kLittleTension) return std::nullopt;
      options_.bilateral_contact = false;
    }
    cycles_left_ -= search_.few_cycles * search_.period;
    options_.first_cycles = search_.few_cycles;
    std::optional<PeriodicOrbit> found;
    if (cycles_left_ >= 0) found = polish_from_coulomb_orbit(coulomb_orbits_now(least));
    options_.bilateral_contact = in_contact;
    options_.first_cycles = 0;
    return found;
  }

  const std::vector<PeriodicOrbit>& coulomb_orbits_now(int least) {
    return search_.coulomb_orbits->find(problem_, options_, origin_, least);
  }

  /// Solves from the first of the orbits whose steps are short enough.
  std::optional<PeriodicOrbit> polish_from_coulomb_orbit(const std::vector<PeriodicOrbit>& orbits) {
    // Coulomb's friction follows the load without a kink where a pair takes over.
    const auto doubt = [&](const PeriodicOrbit& orbit) {
      return std::max(kCoulombErrorFactor * orbit.estimated_error,
                      problem_.grids.with_steps(orbit.steps_per_mesh_cycle).kink_error());
    };
    const auto fits = std::find_if(orbits.begin(), orbits.end(), [&](const auto& each) {
      return doubt(each) <= kShareOfSteps * problem_.tolerance;
    });
    if (fits == orbits.end()) return std::nullopt;
    const MeshGrid& grid = problem_.grids.with_steps(fits->steps_per_mesh_cycle);
    // Computed here, so that all copies of the orbit hold it.
    fits->jacobian->flip_margin();
    fits->jacobian->floquet_radius_below(1 - margin(problem_, search_.period));
    orbit_ = *fits;
    options_.tolerance = problem_.tolerance - doubt(*fits);
    if (!solver_.solve(grid, options_, orbit_)) {
      is_over_ = problem_.tally.take_refusal() != ContactStatus::kOk;
      return std::nullopt;
    }
    const bool is_alike = options_.bilateral_contact ? orbit_.least_pressing_force >= 0
                                                     : orbit_.contact_loss && fits->contact_loss;
    if (!is_alike || !attracts(grid)) return std::nullopt;
    orbit_.estimated_error = doubt(*fits) + orbit_.picard_error;
    return std::move(orbit_);
  }

  /// Returns false if there is no orbit on the grid; sets is_over_ if none is to be expected on
  /// another grid.
  bool solve_on_grid(const MeshGrid& grid) {
    // The tolerance is shared by the error of the steps and the Picard error.
    options_.tolerance = coarser_.is_possible() ? kPicardShare * problem_.tolerance
                                                : std::max(5 * problem_.tolerance, 1e-4);
    bool found = false;
    if (options_.bilateral_contact) {
      found = solve_in_contact(grid);
      if (is_in_tension_) return false;
    } else if (std::exchange(is_in_tension_, false)) {
      found = solve_with_backlash(grid);
    }
    if (is_over_) return false;
    if (is_tapping_ && !coarser_.is_possible()) {
      if (grid.steps() < kTapSteps) return false;
      start_tapping(grid);
    }
    if (!found) found = march_then_solve(grid);
    if (is_over_) return false;
    if (found && coarser_.is_possible()) found = iterate_further(grid);
    if (found) return true;
    // An orbit of a coarser grid that is lost is near a fold: some grids have it, others do not.
    failures_ += coarser_.is_possible() ? 2 : 1;
    is_over_ = problem_.tally.take_refusal() != ContactStatus::kOk ||
               !search_.allow_transient_march || failures_ >= kMostFailures;
    coarser_.clear();
    return false;
  }

  /// Solves under bilateral contact. Under tension contact is lost from then on: under a little, an
  /// orbit with contact loss near this one is tried; otherwise the start decides. On a grid of
  /// fewer steps than contact loss needs, sets is_in_tension_ and returns false: the next grid
  /// decides.
  bool solve_in_contact(const MeshGrid& grid) {
    options_.first_cycles = 0;
    const bool solved = solve(grid);
    const bool has_few_steps = grid.steps() < least_;
    if (solved && !(orbit_.least_pressing_force < -doubtful_tension_)) {
      // Tension by the steps' error falls with the grid. Undivided, one more random scene is
      // marched; divided by 16, random scenes and sweeps come out the same.
      if (!has_few_steps) doubtful_tension_ /= 4;
      return true;
    }
    const bool is_refused = problem_.tally.take_refusal() != ContactStatus::kOk;
    is_in_tension_ = has_few_steps;
    if (has_few_steps && (!solved || orbit_.least_pressing_force > -kDoubtOfFewSteps)) return false;
    is_over_ = is_refused;
    options_.bilateral_contact = false;
    orbit_.distance_since_jacobian = std::numeric_limits<double>::infinity();  // made without a gap
    coarser_.clear();
    is_near_ = solved && orbit_.least_pressing_force >= -kLittleTension;
    return !is_over_ && !has_few_steps && solve_with_backlash(grid);
  }

  /// Once tension has shown that contact is lost. Returns false if the start decides.
  bool solve_with_backlash(const MeshGrid& grid) {
    if (std::exchange(is_near_, false)) {
      if (solver_.solve(grid, options_, orbit_)) return true;
      is_over_ = problem_.tally.take_refusal() != ContactStatus::kOk;
      if (is_over_) return false;
    }
    start_tapping(grid);
    return false;
  }

  /// Starts where flanks tap each other, if the load is so light that they must. From the static
  /// equilibrium they would be thrown far into the backlash, and so light a load takes hundreds of
  /// mesh cycles to bring them back.
  void start_tapping(const MeshGrid& grid) {
    const auto start = tapping_start(system_, origin_.torques, grid, problem_.mean_pinion_speed);
    if (!start) return;
    origin_.state = *start;
    is_tapping_ = true;
  }

  /// Newton's method converges to the orbit that is near, if need be on another grid; others are
  /// found after a transient.
  bool march_then_solve(const MeshGrid& grid) {
    const bool is_last = failures_ + 1 >= kMostFailures;
    for (const int cycles : {is_tapping_ ? 0 : search_.few_cycles, search_.first_cycles}) {
      if (!coarser_.is_possible()) cycles_left_ -= cycles * search_.period;
      if (cycles_left_ < 0) {
        problem_.tally.take_refusal();
        is_over_ = true;
        return false;
      }
      options_.first_cycles = cycles;
      if (solve(grid)) return true;
      if (coarser_.is_possible() || search_.few_cycles == search_.first_cycles) break;
      if (search_.few_cycles == 0 && !is_last) break;
    }
    return false;
  }

  /// Solves from the coarser grid's orbit, or without friction from the start.
  bool solve(const MeshGrid& grid) {
    if (!coarser_.is_possible()) {
      const bool is_near = !options_.bilateral_contact && options_.first_cycles == 0;
      orbit_ = origin_;
      const bool good = is_near ? solver_.march_one_period(grid, options_, orbit_)
                                : solver_.solve_without_friction(grid, options_, orbit_);
      if (!good) return false;
    }
    return solver_.solve(grid, options_, orbit_);
  }

  /// Iterates further if only the Picard error is too large: that is cheaper than another grid.
  bool iterate_further(const MeshGrid& grid) {
    const double left = problem_.tolerance - step_error(grid);
    if (!(left > 0) || orbit_.picard_error <= left) return true;
    ShootingOptions more = options_;
    more.tolerance = left;
    more.share_of_change = 0;
    return solver_.solve(grid, more, orbit_);
  }

  /// Whether the orbit surely attracts.
  bool attracts(const MeshGrid& grid) {
    // A Jacobian from near may miss a flank that hardly parts, and the effect of friction on the
    // multipliers: 0.02 near a period doubling.
    const bool doubles = orbit_.jacobian->flip_margin() < kSmallFlipMargin;
    if ((orbit_.contact_loss || doubles) && !solver_.renew_jacobian(grid, options_, orbit_)) {
      return false;
    }
    double doubt = margin(problem_, search_.period);
    if (orbit_.jacobian->floquet_radius_below(1 - doubt)) return true;
    double multiplier = orbit_.jacobian->largest_multiplier();
    if (std::abs(multiplier - 1) <= doubt) {
      if (!find_multiplier_with_friction(doubt)) return false;
      multiplier = *orbit_.multiplier_with_friction;
    }
    if (multiplier < 1 - doubt) return true;
    if (multiplier <= 1 + doubt && !doubles) return orbit_.barely_attracts = true;
    // If the multiplier does not decide, the doubled period is tried.
    doubles_ =
        doubles || (multiplier > 1 + doubt && orbit_.jacobian->leading_multiplier_is_negative());
    repels_ = doubles_ || (multiplier > 1 + doubt && orbit_.period > 1);
    return false;
  }

  /// By the derivatives of the orbit, or if they do not decide, by the march. Sets the doubt.
  bool find_multiplier_with_friction(double& doubt) {
    orbit_.multiplier_with_friction = multiplier_with_friction(problem_, orbit_);
    doubt = kDoubtOfSteps;
    const bool is_clear =
        orbit_.multiplier_with_friction && std::abs(*orbit_.multiplier_with_friction - 1) > doubt;
    if (is_clear) return true;
    doubt = kMarchedDoubt;
    return march_multiplier();
  }

  bool march_multiplier() {
    orbit_.multiplier_with_friction.reset();
    MarchOptions march;
    march.relative_tolerance = 1e-8;
    march.interrupted = problem_.interrupted;
    try {
      orbit_.multiplier_with_friction = marched_multiplier(problem_, orbit_, march, work_);
    } catch (const Refusal&) {  // then the march does not decide
    }
    return orbit_.multiplier_with_friction.has_value();
  }

  const PeriodicProblem& problem_;
  const GearPairSystem& system_;
  const OrbitSearch& search_;
  OrbitSolver& solver_;
  SolverWork& work_;
  int& cycles_left_;
  ShootingOptions options_;
  PeriodicOrbit origin_, orbit_;
  GridComparison coarser_;
  int failures_ = 0;
  double doubtful_tension_ =
      kTensionForSeparation;    // of the mean force: as little may be the steps' error
  int least_ = 0;               // steps, where contact may be lost
  bool is_in_tension_ = false;  // on a grid of fewer steps than least_
  bool is_near_ = false;        // `orbit_` to an orbit with contact loss
  bool is_tapping_ = false;     // at the start
  bool is_over_ = false, repels_ = false, doubles_ = false;
};

}  // namespace

double mesh_oscillations(const GearPairSystem& system, double mean_pinion_speed) {
  return system.mesh_frequency() / (mean_pinion_speed * system.mesh().pinion_teeth());
}

bool oscillates_too_often(double mesh_oscillations) {
  return kStepsPerOscillation * mesh_oscillations > kMostStepsPerCycle;
}

std::optional<PeriodicOrbit> find_orbit(const PeriodicProblem& problem, const OrbitSearch& search,
                                        SolverWork& work, std::optional<SectionPoint>& aperiodic) {
  constexpr int kLongestPeriod = 4;
  OrbitSearch next = search;
  int cycles_left = search.maximum_mesh_cycles;
  OrbitSolver solver(problem, work);
  std::optional<SectionPoint> beside;
  for (bool has_marched = false;; has_marched = true) {
    const auto refinement_from = [&](const Torques& torques) {
      return GridRefinement(problem, next, torques, solver, work, cycles_left);
    };
    GridRefinement refinement = refinement_from(problem.torques);
    auto found = refinement.refine();
    const bool repels = refinement.repels();
    while (found && next.period % 2 == 0 && is_half_as_long(problem, *found)) {
      next.period /= 2;
      next.start = found->state;
      next.few_cycles = next.first_cycles = 1;
      auto shorter = refinement_from(found->torques).refine();
      if (!shorter) break;
      found = std::move(shorter);
    }
    if (found) return found;
    // The doubled orbit repels too, and a longer one does as well or does not exist after hundreds
    // of cycles: no orbit attracts.
    if (repels && next.period > 1) aperiodic = beside;
    if ((has_marched && !repels) || 2 * next.period > kLongestPeriod) return found;
    if (!search.allow_transient_march) return found;
    // After a flip bifurcation or a fold: retry with a doubled period, or after a long transient.
    if (repels) {
      next.period *= 2;
      if (refinement.doubles()) {
        beside = refinement.beside_repelling();
        next.start = beside->state;
      }
    }
    if (!repels && search.try_contact_first) return found;
    next.try_contact_first = false;
    next.few_cycles = next.first_cycles = kTransientPeriods;
    next.renew_friction = true;
    next.coulomb_orbits = nullptr;
  }
}

}  // namespace tribodyn
