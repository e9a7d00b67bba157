#include "core/study/quasi_static_point.h"

#include <algorithm>
#include <utility>

#include "core/integrate/mesh_cycle_march.h"
#include "core/refusal.h"
#include "core/study/history_sampler.h"
#include "core/study/point_by_shooting.h"

namespace tribodyn {
namespace {

/// Samples the history: solves the equilibrium anew at each phase, by the scalar kernel. Throws
/// Cancelled, and the refusal of a contact.
void sample_quasi_static(const PeriodicProblem& problem, PeriodicOrbit& solution,
                         HistorySampler& history) {
  const GearPairSystem& system = problem.system;
  const ContactRegime regime = solution.pieces.front().regime;
  ContactSolver contacts(problem.contacts.model(), problem.tally);
  Instant at;
  while (history.wanted_in_first_cycles(1)) {
    if (problem.interrupted && problem.interrupted()) throw Cancelled();
    const double phase = history.next_phase();
    const MeshPhase mesh_phase = system.at_phase(phase);
    FrictionArms friction = solution.friction.at(phase);
    MarchState y{};
    for (int i = 0; i < 8; ++i) {
      y = static_equilibrium(system, solution.torques, regime.side, mesh_phase, phase, friction,
                             problem.mean_pinion_speed);
      throw_if_refused(
          system.evaluate(phase, system.mesh().interval_at(phase), regime, y.data(), contacts, at));
      const double load = std::abs(at.mesh_force);
      if (!(load > 0)) break;
      friction = {at.pinion_friction_torque / load, at.gear_friction_torque / load};
    }
    history.add(phase, y.data(), at, solution.torques);
  }
  history.repeat_first_cycles(1, system.cycle_angle() / problem.mean_pinion_speed);
}

}  // namespace

PeriodicProblem quasi_static_problem(const PointProblem& problem) {
  // The rest is for the model's error. Over the quasi-static scenes of core/README.md 0.25
  // takes 2.2 times the contacts, 0.9 takes 5 % fewer, but leaves little to the model.
  constexpr double kGridShare = 0.5;
  return problem.periodic(kGridShare * problem.options.tolerance);
}

std::optional<PeriodicOrbit> solve_quasi_static_with_error(const PointProblem& problem) {
  const PeriodicProblem periodic = quasi_static_problem(problem);
  std::optional<PeriodicOrbit> out = solve_quasi_static(periodic);
  if (out) out->estimated_error += quasi_static_model_error(periodic, *out);
  return out;
}

bool may_choose(const PointOptions& options, const std::optional<CarriedState>& from) {
  return options.model == PointModel::kAutomatic &&
         options.method == SteadyStateMethod::kAutomatic &&
         options.start == PointStart::kQuasiStatic && !from && !options.probe_coexisting_response &&
         options.history.columns.empty() && !options.sensitivities;
}

std::optional<PeriodicOrbit> choose_quasi_static(const PointProblem& problem) {
  QuasiStaticScreen& screen = problem.gear_set.quasi_static_screen();
  if (!screen.passes(quasi_static_problem(problem))) return std::nullopt;
  auto solution = solve_quasi_static_with_error(problem);
  if (solution && solution->estimated_error <= problem.options.tolerance) return solution;
  problem.tally.take_refusal();
  return std::nullopt;
}

PointResult quasi_static_result(const PointProblem& problem, PeriodicOrbit& solution) {
  PointResult out = empty_result(problem.target, PointModel::kQuasiStatic);
  out.estimated_relative_error = known_error(solution.estimated_error);
  fill_from_orbit(problem, solution, out);
  // Speeds are taken as they follow each other, and the unknown torque from the mean power: neither
  // dampers nor what eq 2 leaves out take anything.
  PowerBalance& balance = out.power_balance;
  balance.shaft_damping = balance.mesh_damping = balance.parametric = 0;
  HistorySampler history(problem.options.history);
  sample_quasi_static(quasi_static_problem(problem), solution, history);
  out.history = history.take();
  out.statistics.contact_solutions = problem.tally.solutions;
  return out;
}

PointResult solve_quasi_static_point(const PointProblem& problem) {
  auto solution = solve_quasi_static_with_error(problem);
  throw_if_refused(problem.tally.refusal);
  if (!solution) {
    throw Refusal("NO_QUASI_STATIC_EQUILIBRIUM",
                  "load and friction of the quasi-static model do not settle");
  }
  return quasi_static_result(problem, *solution);
}

}  // namespace tribodyn
