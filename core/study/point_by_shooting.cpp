#include "core/study/point_by_shooting.h"

#include <utility>

#include "core/number_text.h"
#include "core/periodic/steady_state.h"
#include "core/refusal.h"
#include "core/study/history_sampler.h"
#include "core/study/orbit_record.h"
#include "core/study/point_start.h"
#include "core/study/response_record.h"
#include "core/study/response_warnings.h"

namespace tribodyn {

SolvedPieces fill_from_orbit(const PointProblem& problem, const PeriodicOrbit& orbit,
                             PointResult& out) {
  const GearPairSystem& system = problem.system();
  out.settled = true;
  out.period_in_mesh_cycles = out.recorded_mesh_cycles = orbit.period;
  SolvedPieces solved =
      solved_pieces(system, problem.gear_set.grids().with_steps(orbit.steps_per_mesh_cycle),
                    orbit.pieces, *orbit.contacts, problem.contacts.model());
  ResponseRecord record(
      march_scales(system, orbit.torques, problem.target.mean_pinion_speed).torque /
          system.mesh().mean_pinion_contact_radius(),
      problem.contacts.model());
  record_orbit(system, orbit, solved, record);
  record.fill(orbit.torques, orbit.period, true, out);
  const OrbitPiece& first = orbit.pieces.front();
  out.power_balance.stored = system.stored_energy(0, first.regime, orbit.pieces.back().end.data()) -
                             system.stored_energy(0, first.regime, first.start.data());
  out.section_state = system.to_section(first.start.data());
  out.statistics.contact_solutions = problem.tally.solutions;
  return solved;
}

std::optional<OrbitSearch> search_from(const PointProblem& problem, PointStart start,
                                       const std::optional<CarriedState>& from) {
  const GearPairSystem& system = problem.system();
  const OperatingTarget& target = problem.target;
  const PointOptions& options = problem.options;
  if (target.torques.pinion == 0) return std::nullopt;  // nothing holds the flanks together
  if (!from && start == PointStart::kLargeVibration) {
    if (const auto loud = loud_response(problem)) return search_from(problem, start, loud);
  }
  OrbitSearch search;
  search.maximum_mesh_cycles = options.maximum_mesh_cycles;
  search.allow_transient_march =
      options.method != SteadyStateMethod::kShooting && !options.gives_up_early;
  if (from) {
    if (from->period == 0) return std::nullopt;
    search.start = carried_start(system, *from, target);
    search.period = from->period;
    search.try_contact_first = !from->contact_loss;
    search.few_cycles = from->contact_loss ? 0 : search.few_cycles;  // an orbit is near
  } else {
    const bool loud = start == PointStart::kLargeVibration;
    search.start = static_start(system, target.torques, target.mean_pinion_speed, 0, 0,
                                loud ? kLargeVibrationDeflection : 0);
    search.try_contact_first = !loud;
  }
  return search;
}

std::optional<OrbitSensitivity> sensitivity_of(const PointProblem& problem,
                                               const PeriodicOrbit& orbit) {
  if (problem.system().options().load_dependent_mesh_data) return std::nullopt;
  return orbit_sensitivity(problem.periodic(problem.options.tolerance), orbit);
}

std::optional<ShotPoint> solve_by_shooting(const PointProblem& problem, PointStart start,
                                           const std::optional<CarriedState>& from,
                                           const HistoryRequest& history_request,
                                           std::optional<SectionPoint>& aperiodic) {
  const std::optional<OrbitSearch> search = search_from(problem, start, from);
  if (!search) return std::nullopt;
  SolverWork work;
  const std::optional<PeriodicOrbit> orbit =
      find_orbit(problem.periodic(problem.options.tolerance), *search, work, aperiodic);
  if (!orbit) return std::nullopt;

  ShotPoint shot{empty_result(problem.target, PointModel::kFull), std::nullopt};
  PointResult& out = shot.result;
  out.method = SteadyStateMethod::kShooting;
  out.estimated_relative_error = known_error(orbit->estimated_error);
  const SolvedPieces solved = fill_from_orbit(problem, *orbit, out);
  HistorySampler history(history_request);
  ContactSolver contacts(problem.contacts.model(), problem.tally);
  sample_orbit(problem.system(), *orbit, solved, contacts, history);
  out.history = history.take();
  if (problem.options.sensitivities) shot.sensitivity = sensitivity_of(problem, *orbit);
  out.warnings = orbit_warnings(*orbit);
  static_cast<SolverWork&>(out.statistics) = work;
  out.statistics.contact_solutions = problem.tally.solutions;
  out.statistics.periodicity_defect = orbit->defect;
  out.statistics.largest_multiplier = orbit->multiplier_with_friction
                                          ? *orbit->multiplier_with_friction
                                          : orbit->jacobian->largest_multiplier();
  out.statistics.distance_to_flip = orbit->jacobian->leading().to_flip;
  out.statistics.distance_to_fold = orbit->jacobian->leading().to_fold;
  return shot;
}

void refuse_shooting(const PointProblem& problem) {
  const OperatingTarget& target = problem.target;
  point_start(problem, PointStart::kQuasiStatic);
  throw Refusal(
      "NOT_FOUND_BY_SHOOTING",
      "method = SHOOTING finds no response, or none that surely attracts, at a mean "
      "pinion speed of " +
          number_text(target.mean_pinion_speed) + " rad/s and " +
          (target.solve_wheel_torque ? "a pinion torque of " + number_text(target.torques.pinion)
                                     : "a wheel torque of " + number_text(target.torques.wheel)) +
          " N m; AUTOMATIC or MARCH may");
}

}  // namespace tribodyn
