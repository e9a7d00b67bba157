#include "core/study/screening.h"

#include <algorithm>
#include <utility>

#include "core/study/operating_point.h"
#include "core/study/point_by_shooting.h"
#include "core/study/quasi_static_point.h"
#include "core/study/range_warnings.h"
#include "core/study/response_warnings.h"

namespace tribodyn {
namespace {

PointFigures figures_of(PreparedScene& prepared, const PointProblem& problem,
                        const PeriodicOrbit& orbit, PointModel model) {
  const GearPairSystem& system = problem.system();
  const OperatingTarget& target = problem.target;
  PointFigures out;
  const OrbitFigures& f = orbit.figures;
  const double turned = orbit.period * system.cycle_angle();
  const double torque =
      input_torque(orbit.torques, static_cast<double>(system.mesh().pinion_teeth()) /
                                      static_cast<double>(system.mesh().gear_teeth()));
  out.pinion_torque = orbit.torques.pinion;
  out.wheel_torque = orbit.torques.wheel;
  out.inefficiency_rms = inefficiency_rms(f.loss_rms, torque);
  out.inefficiency_energy_mean = 100 * f.loss_energy / (torque * turned);
  out.mesh_loss_power = f.loss_energy * target.mean_pinion_speed / turned;
  out.dte_minimum = f.dte_minimum;
  out.dte_maximum = f.dte_maximum;
  out.contact_loss = orbit.contact_loss;
  out.settled = true;
  out.period_in_mesh_cycles = orbit.period;
  out.estimated_relative_error = known_error(orbit.estimated_error);
  out.contact_solutions = problem.tally.solutions;
  out.model = model;
  const bool with_sentences = problem.options.warning_sentences;
  out.warnings = range_warnings(prepared.scene(),
                                range_figures(prepared, orbit, model, target.mean_pinion_speed),
                                with_sentences);
  for (RangeWarning& each : orbit_warnings(orbit)) out.warnings.push_back(std::move(each));
  if (auto other = coexistence_warning(problem, orbit.contact_loss)) {
    out.warnings.push_back(*std::move(other));
  }
  if (problem.options.contact_summary) out.contact = contact_summary(problem, orbit);
  return out;
}

enum class StepErrors { kByShorterSteps, kByCoulombOrbit };

/// Returns nullopt if neither the quasi-static model nor shooting finds the response.
std::optional<PointFigures> find_figures(PreparedScene& prepared,
                                         const OperatingCondition& condition,
                                         const PointOptions& options, StepErrors step_errors) {
  const Scene& scene = prepared.scene();
  const OperatingTarget target = target_of(scene, condition);
  PreparedGearSet& gear_set = prepared.gear_set();
  ContactTally tally;
  const PointProblem problem{prepared.contacts(), gear_set, target, options, tally};
  std::optional<PeriodicOrbit> quasi_static;
  if (options.model == PointModel::kQuasiStatic && target.torques.pinion != 0) {
    quasi_static = solve_quasi_static_with_error(problem);
  } else if (may_choose(options, std::nullopt)) {
    quasi_static = choose_quasi_static(problem);
  }
  if (quasi_static) return figures_of(prepared, problem, *quasi_static, PointModel::kQuasiStatic);
  if (options.model == PointModel::kQuasiStatic) return std::nullopt;
  std::optional<OrbitSearch> search = search_from(problem, options.start, std::nullopt);
  if (!search) return std::nullopt;
  if (step_errors == StepErrors::kByCoulombOrbit)
    search->coulomb_orbits = &gear_set.coulomb_orbits();
  SolverWork work;
  std::optional<SectionPoint> aperiodic;
  const std::optional<PeriodicOrbit> orbit =
      find_orbit(problem.periodic(options.tolerance), *search, work, aperiodic);
  if (!orbit && options.gives_up_early) refuse_shooting(problem);
  if (!orbit) return std::nullopt;
  PointFigures figures = figures_of(prepared, problem, *orbit, PointModel::kFull);
  if (options.sensitivities) {
    if (const auto sensitivity = sensitivity_of(problem, *orbit)) {
      figures.sensitivities = point_sensitivities(scene, condition, orbit->torques, *sensitivity);
    }
  }
  return figures;
}

PointFigures figures_at(PreparedScene& prepared, const OperatingCondition& condition,
                        const PointOptions& options, StepErrors step_errors) {
  PointOptions plain = options;
  plain.carried_state.reset();
  plain.probe_coexisting_response = false;
  plain.history = {};
  if (options.method == SteadyStateMethod::kAutomatic &&
      !prepared.scene().options.load_dependent_mesh_data) {
    if (auto found = find_figures(prepared, condition, plain, step_errors)) return *found;
    // The quasi-static model has been tried.
    if (plain.model == PointModel::kAutomatic) plain.model = PointModel::kFull;
  }
  return main_figures(solve_prepared_point(prepared, condition, plain));
}

}  // namespace

bool responses_coexist(const PointFigures& figures) {
  return std::any_of(figures.warnings.begin(), figures.warnings.end(),
                     [](const RangeWarning& each) { return each.code == "RESPONSES_COEXIST"; });
}

PointFigures main_figures(const PointResult& r) {
  return {r.pinion_torque,
          r.wheel_torque,
          r.inefficiency_rms,
          r.inefficiency_energy_mean,
          r.mesh_loss_power,
          r.dynamic_transmission_error.minimum,
          r.dynamic_transmission_error.maximum,
          r.contact_loss,
          r.settled,
          r.period_in_mesh_cycles,
          r.estimated_relative_error,
          r.statistics.contact_solutions,
          r.model,
          r.warnings,
          contact_summary(r),
          r.sensitivities};
}

PointFigures solve_point_figures(PreparedScene& prepared, const OperatingCondition& condition,
                                 const PointOptions& options) {
  return figures_at(prepared, condition, options, StepErrors::kByShorterSteps);
}

PointFigures screen_point(PreparedScene& prepared, const OperatingCondition& condition,
                          const PointOptions& options) {
  return figures_at(prepared, condition, options, StepErrors::kByCoulombOrbit);
}

}  // namespace tribodyn
