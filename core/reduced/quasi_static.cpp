#include "core/reduced/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/numerics/square.h"
#include "core/periodic/grid_convergence.h"
#include "core/reduced/linear_response.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

// Limits of the estimate of the model's error, over the quasi-static scenes of core/README.md.
// Factor on the first-order change by inertia: with 1, 25 of 222 scenes err more than estimated.
constexpr double kMargin = 1.5;
// See InertialCorrection. A caution: with 0.9 seven more scenes have an estimate, all of them
// bounds; with 0.25, 42 fewer.
constexpr double kMostGrowth = 0.5;
// Smallest over mean mesh force. A caution: with 0.1 five more scenes have an estimate, all of them
// bounds; with 0.7, 31 fewer.
constexpr double kLeastForce = 0.4;

/// The flanks that carry stay in contact.
ContactRegime regime_under(const Torques& torques) { return {torques.pinion >= 0 ? 1 : -1, true}; }

/// Equilibria at the nodes of a grid.
std::vector<MarchState> equilibria(const GearPairSystem& system, const Torques& torques,
                                   ContactRegime regime, const MeshGrid& grid,
                                   FrozenFriction& friction, double speed) {
  const int last = 2 * grid.steps();
  std::vector<MarchState> out(last + 1);
  for (int n = 0; n <= last; ++n) {
    const double phase = static_cast<double>(n) / last;
    out[n] = static_equilibrium(system, torques, regime.side, grid.at(n), phase, friction.at(phase),
                                speed);
  }
  return out;
}

std::vector<OrbitPiece> pieces_of(ContactRegime regime, const std::vector<MarchState>& nodes) {
  const int steps = static_cast<int>(nodes.size() / 2);
  std::vector<OrbitPiece> out(steps);
  for (int i = 0; i < steps; ++i) {
    out[i] = {static_cast<double>(i) / steps,
              1.0 / steps,
              2 * i,
              regime,
              nodes[2 * i],
              nodes[2 * i + 1],
              nodes[2 * i + 2]};
  }
  return out;
}

/// The unknown torque at which the mean power of both shafts differs by `loss` [W].
double torque_of(const PeriodicProblem& problem, const Torques& torques, double loss) {
  const MeshData& mesh = problem.system.mesh();
  const double ratio = mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
  const double drag = loss / problem.mean_pinion_speed;
  return problem.solve_wheel_torque ? (torques.pinion - drag) / ratio
                                    : ratio * torques.wheel + drag;
}

/// Extremes of a smooth periodic function by parabolas through its nodes; the last node repeats the
/// first.
void extremes_of(const std::vector<double>& v, double& low, double& high) {
  const int count = static_cast<int>(v.size()) - 1;
  low = *std::min_element(v.begin(), v.end());
  high = *std::max_element(v.begin(), v.end());
  const double node_low = low, node_high = high;
  for (int n = 0; n < count; ++n) {
    if (v[n] != node_low && v[n] != node_high) continue;
    const double before = v[(n + count - 1) % count], after = v[n + 1];
    const double bend = before - 2 * v[n] + after, slope = 0.5 * (after - before);
    if (bend == 0 || std::abs(slope) > std::abs(bend)) continue;
    const double vertex = v[n] - 0.5 * slope * slope / bend;
    low = std::min(low, vertex);
    high = std::max(high, vertex);
  }
}

/// x at the nodes.
std::vector<double> transmission_errors(const GearPairSystem& system, ContactRegime regime,
                                        const MeshGrid& grid,
                                        const std::vector<MarchState>& nodes) {
  std::vector<double> out(nodes.size());
  Instant at;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    system.kinematics(grid.at(static_cast<int>(n)), regime, nodes[n].data(), at);
    out[n] = at.transmission_error;
  }
  return out;
}

/// The Picard iteration of load and friction on one grid.
class PicardIteration {
 public:
  explicit PicardIteration(const PeriodicProblem& problem)
      : problem_(problem),
        system_(problem.system),
        regime_(regime_under(problem.torques)),
        friction_(problem.system, problem.contacts, problem.tally, problem.tolerance) {}

  /// Iterates from the torques, friction and figures of `orbit` until the Picard error is below
  /// `enough`.
  bool solve(const MeshGrid& grid, double enough, PeriodicOrbit& orbit) {
    // The quasi-static scenes of core/README.md need at most 12 iterations. The contraction that is
    // assumed before two changes measure it is three times the usual one; with 0.9 they take 13 %
    // more contacts.
    constexpr int kMostIterations = 30;
    constexpr double kUnmeasured = 0.1;
    double last_change = 0;
    for (int i = 0; i < kMostIterations; ++i) {
      if (problem_.interrupted && problem_.interrupted()) throw Cancelled();
      const bool first = contraction_ == 0;
      const OrbitFigures previous = orbit.figures;
      if (!evaluate(grid, orbit)) return false;
      if (first) {
        contraction_ = kUnmeasured;
        continue;
      }
      const double change = orbit.figures.distance(previous);
      if (last_change > 0) contraction_ = std::clamp(change / last_change, 0.01, 0.9);
      last_change = change;
      orbit.picard_error = change * contraction_ / (1 - contraction_);
      if (orbit.picard_error > enough && !(change < 1e-13)) continue;
      orbit.contacts = friction_.take_contacts();
      return true;
    }
    return false;
  }

 private:
  bool evaluate(const MeshGrid& grid, PeriodicOrbit& orbit) {
    const double speed = problem_.mean_pinion_speed;
    const std::vector<MarchState> nodes =
        equilibria(system_, orbit.torques, regime_, grid, orbit.friction, speed);
    orbit.pieces = pieces_of(regime_, nodes);
    OrbitFigures& f = orbit.figures;
    if (!friction_.evaluate(grid, orbit.pieces, orbit.torques, 0, orbit.friction, f)) return false;
    extremes_of(transmission_errors(system_, regime_, grid, nodes), f.dte_minimum, f.dte_maximum);
    f.torque = torque_of(problem_, orbit.torques, f.loss_energy * speed / system_.cycle_angle());
    problem_.unknown(orbit.torques) = f.torque;
    orbit.state = nodes.front();
    return true;
  }

  const PeriodicProblem& problem_;
  const GearPairSystem& system_;
  ContactRegime regime_;
  OrbitFriction friction_;
  double contraction_ = 0;  // of the error by one iteration; 0: none made yet
};

/// The motion of the equilibria at a grid's nodes, and the torques that they leave unbalanced.
/// `friction`: under which the nodes are in equilibrium.
ImposedMotion imposed_motion(const GearPairSystem& system, const Torques& torques,
                             ContactRegime regime, const MeshGrid& grid,
                             const std::vector<MarchState>& nodes, FrozenFriction& friction) {
  const std::size_t count = nodes.size() - 1;
  ImposedMotion out;
  out.resize(count);
  if (system.options().energy_consistent) out.pinion_torque.resize(count);
  Instant at;
  for (std::size_t n = 0; n < count; ++n) {
    const double phase = static_cast<double>(n) / static_cast<double>(count);
    system.kinematics(grid.at(static_cast<int>(n)), regime, nodes[n].data(), at);
    out.mesh_approach[n] = nodes[n][kMeshApproach];
    out.transmission_error[n] = at.transmission_error;
    out.mesh_stiffness[n] = at.mesh.mesh_stiffness;
    out.gear_torque[n] = at.mesh.gear_contact_radius * at.mesh_force +
                         friction.at(phase).gear * std::abs(at.mesh_force) - torques.wheel;
    if (!out.pinion_torque.empty()) out.pinion_torque[n] = GearPairSystem::parametric_torque(at);
  }
  return out;
}

/// The corrected motion at the nodes.
std::vector<MarchState> corrected(const GearPairSystem& system, const MeshGrid& grid,
                                  std::vector<MarchState> nodes, const InertialCorrection& change) {
  const double lag = system.mesh().gear_teeth() / system.mesh().mean_gear_contact_radius();
  const std::size_t count = nodes.size() - 1;
  for (std::size_t n = 0; n <= count; ++n) {
    const std::size_t i = n % count;
    MarchState& y = nodes[n];
    y[kMeshApproach] += change.transmission_error[i];
    y[kPinionSpeed] += change.pinion_speed[i];
    y[kPinionShaftSpeed] += change.pinion_shaft_speed[i];
    const MeshFunctions f =
        system.mesh().functions(grid.at(static_cast<int>(n)), lag * y[kMeshApproach]);
    y[kGearSpeed] =
        ((f.pinion_contact_radius - f.static_transmission_error_slope) * y[kPinionSpeed] -
         change.transmission_velocity[i]) /
        f.gear_contact_radius;
  }
  return nodes;
}

/// Power that the dampers and the torques that eq 2 leaves out take, the mean of it [W].
double other_losses(const GearPairSystem& system, ContactRegime regime, const MeshGrid& grid,
                    const std::vector<MarchState>& nodes) {
  const std::size_t count = nodes.size() - 1;
  double sum = 0;
  Instant at;
  for (std::size_t n = 0; n < count; ++n) {
    const MarchState& y = nodes[n];
    system.kinematics(grid.at(static_cast<int>(n)), regime, y.data(), at);
    sum += at.damper_force * at.transmission_velocity +
           system.dynamics().pinion_shaft_damping * square(y[kPinionShaftSpeed] - y[kPinionSpeed]);
    if (!system.options().energy_consistent) {
      sum += GearPairSystem::parametric_torque(at) * y[kPinionSpeed];
    }
  }
  return sum / static_cast<double>(count);
}

/// Smallest force at the nodes over the mean one.
double least_force(const GearPairSystem& system, ContactRegime regime, const MeshGrid& grid,
                   const std::vector<MarchState>& nodes) {
  double low = 1e300, sum = 0;
  Instant at;
  for (std::size_t n = 0; n + 1 < nodes.size(); ++n) {
    system.kinematics(grid.at(static_cast<int>(n)), regime, nodes[n].data(), at);
    const double force = regime.side * at.mesh_force;
    low = std::min(low, force);
    sum += force;
  }
  return low * static_cast<double>(nodes.size() - 1) / sum;
}

}  // namespace

MarchState static_equilibrium(const GearPairSystem& system, const Torques& torques, int side,
                              const MeshPhase& at, double phase, const FrictionArms& friction,
                              double speed) {
  const MeshData& mesh = system.mesh();
  const double lag = mesh.gear_teeth() / mesh.mean_gear_contact_radius();
  const double ratio = mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
  const MeshFunctions& p = at.pinion;
  const double force = torques.pinion / (p.pinion_contact_radius - side * friction.pinion);
  const double approach = side * system.dynamics().half_backlash + force / p.mesh_stiffness +
                          p.static_transmission_error - system.dynamics().half_backlash;
  MarchState y{};
  MeshFunctions f{};
  y[kMeshApproach] = approach;
  for (int i = 0; i < 4;
       ++i) {  // R_g's ripple over the mesh approach: contracts by 1e-2 and is tiny
    f = system.mesh().functions(at, lag * y[kMeshApproach]);
    y[kMeshApproach] = approach - f.radius_integral;
  }
  y[kTime] = phase * system.cycle_angle() / speed;
  y[kPinionShaftSpeed] = y[kPinionSpeed] = speed;
  y[kGearSpeed] =
      (f.pinion_contact_radius - f.static_transmission_error_slope) * speed / f.gear_contact_radius;
  y[kWheelSpeed] = ratio * speed;
  y[kPinionShaftTwist] = torques.pinion / system.dynamics().pinion_shaft_stiffness;
  y[kGearShaftTwist] = torques.wheel / system.dynamics().gear_shaft_stiffness;
  return y;
}

std::optional<PeriodicOrbit> solve_quasi_static(const PeriodicProblem& problem) {
  PicardIteration iteration(problem);
  PeriodicOrbit best;
  best.torques = problem.torques;
  const int least = problem.tolerance < kLooseTolerance ? 24 : 12;
  const StepSequence sequence(problem.system.mesh().intervals(),
                              std::max(least, least_steps_for_orders(problem)));
  GridComparison coarser(problem);
  for (int steps = sequence.first(); steps <= kMostStepsPerCycle;
       steps = sequence.after(steps, best.estimated_error / problem.tolerance)) {
    const MeshGrid& grid = problem.grids.with_steps(steps);
    const bool first = !coarser.is_possible();
    const double enough = first ? std::max(5 * problem.tolerance, 1e-4) : 0.2 * problem.tolerance;
    if (!iteration.solve(grid, enough, best)) return std::nullopt;
    best.steps_per_mesh_cycle = steps;
    if (!first) {
      best.estimated_error = coarser.error(grid, best.figures) + best.picard_error;
      if (best.estimated_error <= problem.tolerance) break;
    }
    coarser.add(steps, best.figures, best.estimated_error);
  }
  return best;
}

double quasi_static_model_error(const PeriodicProblem& problem, const PeriodicOrbit& solution) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  const GearPairSystem& system = problem.system;
  const Torques& torques = solution.torques;
  const ContactRegime regime = solution.pieces.front().regime;
  const double speed = problem.mean_pinion_speed;
  const MeshGrid& grid = problem.grids.with_steps(solution.steps_per_mesh_cycle);
  FrozenFriction friction = solution.friction;
  const std::vector<MarchState> still = equilibria(system, torques, regime, grid, friction, speed);
  const ImposedMotion motion = imposed_motion(system, torques, regime, grid, still, friction);
  const InertialCorrection change = inertial_correction(system, speed, motion);
  if (!(change.growth < kMostGrowth)) return kUnknown;
  if (parametric_resonance_possible(system, speed, motion.mesh_stiffness)) return kUnknown;
  const std::vector<MarchState> moving = corrected(system, grid, still, change);
  const double unresolved_force = change.unresolved * system.mesh().mean_mesh_stiffness() *
                                  system.mesh().mean_pinion_contact_radius() /
                                  std::abs(torques.pinion);
  if (!(least_force(system, regime, grid, moving) - unresolved_force > kLeastForce))
    return kUnknown;

  OrbitFriction together(system, problem.contacts, problem.tally, problem.tolerance);
  OrbitFigures figures;
  if (!together.evaluate(grid, pieces_of(regime, moving), torques, 0, friction, figures)) {
    problem.tally.take_refusal();
    return kUnknown;
  }
  const double loss = figures.loss_energy * speed / system.cycle_angle();
  figures.torque = torque_of(problem, torques, loss + other_losses(system, regime, grid, moving));
  const double first_order = figures.distance(solution.figures);
  const double size = std::max(std::abs(figures.dte_minimum), std::abs(figures.dte_maximum));
  const int harmonics = std::min(grid.steps() - 1, kMostCorrectedHarmonics);
  return kMargin * first_order / (1 - change.growth) + change.unresolved / size +
         weight_beyond(system, torques, speed, harmonics);
}

bool passes_quasi_static_screen(const PeriodicProblem& problem) {
  // Three harmonics; with seven (8 steps) the same of the quasi-static scenes pass at 1e-2.
  constexpr int kFewSteps = 4;
  // Extremes move by less than the largest correction. At 1e-2 the quasi-static model answers 119
  // of the quasi-static scenes, with 1 only 84, with 8 119 for 0.9 % more contacts.
  constexpr double kDoubt = 4;
  const GearPairSystem& system = problem.system;
  const Torques& torques = problem.torques;
  MeshGrids& grids = problem.grids;
  if (torques.pinion == 0 ||
      resonant_weight(system, torques, problem.mean_pinion_speed) > problem.tolerance) {
    return false;
  }
  const ContactRegime regime = regime_under(torques);
  const double speed = problem.mean_pinion_speed;
  const auto moved_without_friction = [&](const MeshGrid& grid, ImposedMotion& motion,
                                          std::vector<MarchState>& still) {
    FrozenFriction none;
    still = equilibria(system, torques, regime, grid, none, speed);
    motion = imposed_motion(system, torques, regime, grid, still, none);
    motion.tail = false;
    return inertial_correction(system, speed, motion);
  };
  ImposedMotion motion;
  std::vector<MarchState> still;
  const InertialCorrection few = moved_without_friction(grids.with_steps(kFewSteps), motion, still);
  double size = 0;
  for (const double x : motion.transmission_error) size = std::max(size, std::abs(x));
  if (!(few.largest < kDoubt * problem.tolerance * size) ||
      parametric_resonance_possible(system, speed, motion.mesh_stiffness)) {
    return false;
  }
  // Friction moves the extremes by some percent only.
  const MeshGrid& grid = grids.with_steps(StepSequence(system.mesh().intervals(), 12).first());
  const InertialCorrection more = moved_without_friction(grid, motion, still);
  if (!(more.growth < kMostGrowth)) return false;
  double low = 0, high = 0, moved_low = 0, moved_high = 0;
  extremes_of(transmission_errors(system, regime, grid, still), low, high);
  extremes_of(transmission_errors(system, regime, grid, corrected(system, grid, still, more)),
              moved_low, moved_high);
  const double moved = std::max(std::abs(moved_low - low), std::abs(moved_high - high));
  return kMargin * moved / (1 - more.growth) < kDoubt * problem.tolerance * size / 2;
}

bool QuasiStaticScreen::passes(const PeriodicProblem& problem) {
  const std::array<double, 5> where = {problem.mean_pinion_speed, problem.torques.pinion,
                                       problem.torques.wheel, problem.tolerance,
                                       static_cast<double>(problem.solve_wheel_torque)};
  if (const auto known = known_.find(where); known != known_.end()) return known->second;
  if (known_.size() >= kMostKept) known_.clear();
  return known_[where] = passes_quasi_static_screen(problem);
}

}  // namespace tribodyn
