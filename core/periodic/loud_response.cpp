#include "core/periodic/loud_response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/driveline/linear_modes.h"
#include "core/integrate/order_weights.h"
#include "core/numerics/square.h"
#include "core/periodic/find_orbit.h"
#include "core/periodic/grid_convergence.h"
#include "core/periodic/orbit_solver.h"
#include "core/periodic/steady_state.h"

namespace tribodyn {
namespace {

// Over its resonance, the lowest speed to which a loud response is followed. (Those of the random
// scenes in tests/support/random_place.h end above 0.6.)
constexpr double kLowest = 0.55;
constexpr double kProbedCoefficient = 0.05;  // lubricated flanks are between 0.02 and 0.1
constexpr double kProbeTolerance = 1e-3;
// About multipliers under frozen friction: see find_orbit.cpp.
constexpr double kDoubtOfMultiplier = 0.006;

/// Where a loud response begins.
struct Resonance {
  double speed;  ///< of the pinion [rad/s]
  int period;    ///< of the response [mesh cycles]
};

/// The frequency of the mode that is mostly that of the mesh [rad/s].
double mesh_mode(const GearPairSystem& system) {
  const double mesh = system.mesh_frequency();
  double nearest = 0;
  for (const LinearMode& mode : linear_modes(system)) {
    if (std::abs(std::log(mode.frequency / mesh)) < std::abs(std::log(nearest / mesh))) {
      nearest = mode.frequency;
    }
  }
  return nearest;
}

/// The resonances whose loud responses may reach a speed. `natural`: of the mesh [rad/s].
std::vector<Resonance> resonances_for(const PeriodicProblem& problem, double natural) {
  constexpr double kHighest = 1.06;  // over the resonance
  // Of the mean force, magnified: at 1 a linear response parts the flanks.
  constexpr double kParts = 0.7;
  // Of the critical damping: at 4 a vibration by ripple sustains itself (linear_response.h).
  constexpr double kRippleOverDamping = 3;
  const GearPairSystem& system = problem.system;
  const double damping_ratio =
      0.5 * system.dynamics().mesh_damping * natural / system.mesh().mean_mesh_stiffness();
  const auto& orders = system.mesh().orders();
  std::vector<Resonance> out;
  for (int order = 1; order <= static_cast<int>(orders.size()); ++order) {
    const double speed = natural / (order * system.mesh().pinion_teeth());
    const auto reaches = [&](double from) {
      return problem.mean_pinion_speed > kLowest * from &&
             problem.mean_pinion_speed < kHighest * from;
    };
    if (reaches(speed) && OrderWeights(system, problem.torques, natural / order).weight(order) >
                              kParts * 2 * damping_ratio) {
      out.push_back({speed, 1});
    }
    if (reaches(2 * speed) && orders[order - 1].stiffness > kRippleOverDamping * damping_ratio) {
      out.push_back({2 * speed, order % 2 == 0 ? 1 : 2});
    }
  }
  return out;
}

/// Solves for orbits with contact loss at one speed after another.
class LoudBranch {
 public:
  explicit LoudBranch(const PeriodicProblem& problem)
      : problem_(problem),
        wanted_(problem.mean_pinion_speed),
        solver_(problem_, work_, kProbedCoefficient) {
    problem_.tolerance = kProbeTolerance;
    options_.tolerance = kProbeTolerance;
    const double oscillations = mesh_oscillations(problem.system, wanted_);
    if (oscillates_too_often(oscillations)) return;
    constexpr int kPerOscillation = 7, kFewestSteps = 24;
    const int least = std::max(kFewestSteps, static_cast<int>(kPerOscillation * oscillations));
    grid_ =
        &problem_.grids.with_steps(StepSequence(problem.system.mesh().intervals(), least).first());
  }

  /// Continues from a resonance down to the speed wanted. Returns false if the branch does not
  /// reach it; speed() is then the last one on it, or infinite if there is no branch.
  bool follow_from(const Resonance& resonance) {
    constexpr double kLongestStep = 0.04, kShortestStep = 0.0025;  // of the speed
    if (grid_ == nullptr || !start(resonance)) {
      problem_.mean_pinion_speed = std::numeric_limits<double>::infinity();
      return false;
    }
    for (double step = kLongestStep; problem_.mean_pinion_speed > wanted_;) {
      if (step < kShortestStep) return false;
      const double next = std::max(wanted_, (1 - step) * problem_.mean_pinion_speed);
      step = continue_to(next) ? std::min(1.5 * step, kLongestStep) : step / 2;
    }
    return true;
  }
  double speed() const { return problem_.mean_pinion_speed; }

  CarriedState state() const {
    return {problem_.system.to_section(orbit_.state.data()),
            problem_.mean_pinion_speed,
            orbit_.torques.pinion,
            orbit_.torques.wheel,
            orbit_.period,
            true};
  }

 private:
  /// Searches at the resonance, or just above it at the speed wanted.
  bool start(const Resonance& resonance) {
    const GearPairSystem& system = problem_.system;
    problem_.mean_pinion_speed = std::max(wanted_, resonance.speed);
    // From some states the transient leads to the quiet response.
    constexpr std::pair<int, double> kTries[] = {{24, 1}, {24, 2}, {24, 4}, {96, 1}};
    for (const auto& [cycles, pressed] : kTries) {
      orbit_ = {};
      orbit_.torques = problem_.torques;
      orbit_.period = resonance.period;
      orbit_.state = static_start(system, orbit_.torques, problem_.mean_pinion_speed, 0, 0,
                                  pressed * system.dynamics().half_backlash);
      options_.first_cycles = cycles;
      const bool good = solver_.solve_without_friction(*grid_, options_, orbit_);
      options_.first_cycles = 0;
      if (good && solver_.solve(*grid_, options_, orbit_) && is_loud(orbit_)) return true;
    }
    return false;
  }

  bool continue_to(double speed) {
    const double before = std::exchange(problem_.mean_pinion_speed, speed);
    PeriodicOrbit next = orbit_;
    next.marched.reset();
    next.jacobian.reset();
    const double shift = speed - before;
    const double ratio = static_cast<double>(problem_.system.mesh().pinion_teeth()) /
                         problem_.system.mesh().gear_teeth();
    next.state[kPinionShaftSpeed] += shift;
    next.state[kPinionSpeed] += shift;
    next.state[kGearSpeed] += ratio * shift;
    next.state[kWheelSpeed] += ratio * shift;
    if (solver_.solve(*grid_, options_, next) && is_loud(next)) {
      orbit_ = std::move(next);
      return true;
    }
    problem_.mean_pinion_speed = before;
    return false;
  }

  /// Whether flanks part on an orbit that attracts: close to a fold Newton's method may find the
  /// orbit that repels.
  bool is_loud(PeriodicOrbit& orbit) {
    return orbit.contact_loss && solver_.renew_jacobian(*grid_, options_, orbit) &&
           orbit.jacobian->largest_multiplier() <= 1 + kDoubtOfMultiplier;
  }

  PeriodicProblem problem_;  // at the speed reached
  double wanted_;
  SolverWork work_;
  OrbitSolver solver_;
  ShootingOptions options_;
  const MeshGrid* grid_ = nullptr;
  PeriodicOrbit orbit_;
};

}  // namespace

std::optional<CarriedState> find_loud_response(const PeriodicProblem& problem) {
  if (problem.torques.pinion == 0) return std::nullopt;
  for (const Resonance& resonance : resonances_for(problem, mesh_mode(problem.system))) {
    LoudBranch branch(problem);
    if (branch.follow_from(resonance)) return branch.state();
  }
  return std::nullopt;
}

bool has_quiet_response(const PeriodicProblem& problem) {
  // Of the mean force: the last percent of the quiet branch parts the flanks a little.
  constexpr double kLittleTensionOfProbe = 0.05;
  if (problem.torques.pinion == 0) return false;
  PeriodicProblem loose = problem;
  loose.tolerance = kProbeTolerance;
  SolverWork work;
  OrbitSolver solver(loose, work, kProbedCoefficient);
  ShootingOptions options;
  options.bilateral_contact = true;
  options.tolerance = kProbeTolerance;
  PeriodicOrbit orbit;
  orbit.torques = problem.torques;
  orbit.state = static_start(problem.system, problem.torques, problem.mean_pinion_speed, 0, 0, 0);
  const MeshGrid& grid =
      problem.grids.with_steps(StepSequence(problem.system.mesh().intervals(), 24).first());
  return solver.solve_without_friction(grid, options, orbit) &&
         solver.solve(grid, options, orbit) &&
         orbit.least_pressing_force > -kLittleTensionOfProbe &&
         orbit.jacobian->largest_multiplier() < 1 + kDoubtOfMultiplier;
}

namespace {

/// The next torque on a lattice that is even in the logarithm: where a branch ends moves little
/// with the torque.
double on_lattice(double torque) {
  constexpr double kRatio = 1.15;
  const double level = std::round(std::log(std::abs(torque)) / std::log(kRatio));
  return std::copysign(std::pow(kRatio, level), torque);
}

}  // namespace

std::optional<CarriedState> OtherResponses::loud(const PeriodicProblem& problem) {
  const StateKey key{problem.mean_pinion_speed, problem.torques.pinion, problem.torques.wheel,
                     static_cast<double>(problem.solve_wheel_torque)};
  if (const auto at = loud_.find(key); at != loud_.end()) return at->second;
  if (loud_.size() >= kMostKept) loud_.clear();
  return loud_[key] = find_loud_response(problem);
}

bool OtherResponses::may_be_loud(const PeriodicProblem& problem) {
  if (problem.torques.pinion == 0) return false;
  if (natural_ == 0) natural_ = mesh_mode(problem.system);
  PeriodicProblem near = problem;
  const double ratio = on_lattice(problem.torques.pinion) / problem.torques.pinion;
  near.torques.pinion *= ratio;
  near.torques.wheel *= ratio;
  for (const Resonance& resonance : resonances_for(near, natural_)) {
    if (problem.mean_pinion_speed > resonance.speed) continue;
    const BranchKey key{near.torques.pinion, static_cast<double>(near.solve_wheel_torque),
                        resonance.speed, static_cast<double>(resonance.period)};
    auto at = lowest_.find(key);
    if (at == lowest_.end()) {
      if (lowest_.size() >= kMostKept) lowest_.clear();
      near.mean_pinion_speed = kLowest * resonance.speed;
      LoudBranch branch(near);
      branch.follow_from(resonance);
      at = lowest_.emplace(key, branch.speed()).first;
    }
    if (problem.mean_pinion_speed >= at->second) return true;
  }
  return false;
}

bool OtherResponses::may_be_quiet(const PeriodicProblem& problem) {
  const StateKey key{problem.mean_pinion_speed, problem.torques.pinion, problem.torques.wheel,
                     static_cast<double>(problem.solve_wheel_torque)};
  if (const auto at = quiet_.find(key); at != quiet_.end()) return at->second;
  if (quiet_.size() >= kMostKept) quiet_.clear();
  return quiet_[key] = has_quiet_response(problem);
}

}  // namespace tribodyn
