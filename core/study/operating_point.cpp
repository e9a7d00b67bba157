#include "core/study/operating_point.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "core/dynamics/steady_state.h"
#include "core/number_text.h"
#include "core/refusal.h"
#include "core/study/history_sampler.h"
#include "core/study/march_plan.h"
#include "core/study/model_choice.h"
#include "core/study/operating_target.h"
#include "core/study/orbit_record.h"
#include "core/study/orbit_refinement.h"
#include "core/study/quasi_static.h"
#include "core/study/range_warnings.h"
#include "core/study/recorded_march.h"
#include "core/study/response_record.h"
#include "core/study/unused_tolerance.h"

namespace tribodyn {
namespace {

SolverStatistics statistics_of(const SteadyState& s) {
  SolverStatistics out;
  out.right_hand_sides = s.statistics.right_hand_sides;
  out.accepted_steps = s.statistics.accepted_steps;
  out.rejected_steps = s.statistics.rejected_steps;
  out.events = s.statistics.events;
  out.mesh_cycles = s.mesh_cycles;
  out.accelerations = s.accelerations;
  out.periodicity_defect = s.defect;
  out.largest_multiplier = s.largest_multiplier;
  return out;
}

PointResult empty_result(const OperatingTarget& target, PointModel model) {
  PointResult out;
  out.vehicle_speed = target.vehicle_speed;
  out.mean_pinion_speed = target.mean_pinion_speed;
  out.model = model;
  return out;
}

/// Infinite: it cannot be told.
template <class Result>
void set_estimate(double error, Result& out) {
  if (std::isfinite(error)) out.estimated_relative_error = error;
}

PointResult solve_by_marching(GearPairSystem& system, const OperatingTarget& target,
                              const PointOptions& options, const MarchPlan& plan,
                              const HistoryRequest& history_request) {
  SteadyStateRequest request;
  request.first_period = plan.first_period;
  request.mean_pinion_speed = target.mean_pinion_speed;
  request.solve_wheel_torque = target.solve_wheel_torque;
  request.march.relative_tolerance = march_tolerance(options);
  request.tolerance = std::min(0.1 * options.tolerance, options.march_settling_tolerance);
  request.maximum_mesh_cycles = plan.maximum_mesh_cycles;
  request.progress = options.progress;
  double reported = 0;
  if (options.progress) {
    request.progress = [&](double fraction) {
      reported = fraction;
      return options.progress(fraction);
    };
    request.march.interrupted = [&] { return !options.progress(reported); };
  }
  const SteadyState steady = solve_steady_state(system, plan.start, request);

  PointResult out = empty_result(target, PointModel::kFull);
  out.settled = steady.settled;
  // Of both by experience: their errors are some ten times smaller.
  if (steady.settled) {
    out.estimated_relative_error = 3 * request.tolerance + 300 * request.march.relative_tolerance;
  }
  out.period_in_mesh_cycles = steady.period;
  out.statistics = statistics_of(steady);
  out.recorded_mesh_cycles = steady.settled ? steady.period : options.recorded_mesh_cycles;
  const MarchScales scales = march_scales(system, target.mean_pinion_speed);
  ResponseRecord record(scales.torque / system.mesh().mean_pinion_contact_radius());
  HistorySampler history(history_request);
  // A speed that is wrong within its tolerance counts I omega times in the energy balance.
  MarchOptions sharper = request.march;
  sharper.relative_tolerance = std::max(0.01 * request.march.relative_tolerance, 1e-12);
  record_response(system, steady, out.recorded_mesh_cycles, sharper, scales, record, history,
                  out.statistics, options.progress);
  out.statistics.contact_solutions += system.contact_solutions();
  record.fill(system.torques(), out.recorded_mesh_cycles, steady.settled, out);
  system.regime = record.end_regime;
  const double end_energy = system.stored_energy(0, record.integrals.data());
  system.regime = steady.regime;
  out.power_balance.stored = end_energy - system.stored_energy(0, steady.state.data());
  out.section_state = system.to_section(steady.state.data());
  out.history = history.take();
  if (plan.why_so_short && !steady.settled) out.warnings.push_back(*plan.why_so_short);
  return out;
}

/// Where shooting starts: from a state or else from the static one. Nothing where marching must
/// decide.
std::optional<OrbitSearch> search_from(const GearPairSystem& system, const OperatingTarget& target,
                                       const PointOptions& options, PointStart start,
                                       const std::optional<CarriedState>& from) {
  if (system.torques().pinion == 0) return std::nullopt;  // nothing holds the flanks together
  OrbitSearch search;
  search.mean_pinion_speed = target.mean_pinion_speed;
  search.solve_wheel_torque = target.solve_wheel_torque;
  search.tolerance = options.tolerance;
  search.maximum_mesh_cycles = options.maximum_mesh_cycles;
  search.patient = options.method != SteadyStateMethod::kShooting;
  if (options.progress) search.interrupted = [&] { return !options.progress(0); };
  if (from) {
    if (from->period == 0) return std::nullopt;
    search.start = carried_start(system, *from, target.mean_pinion_speed);
    search.period = from->period;
    search.try_contact_first = !from->contact_loss;
    search.few_cycles = from->contact_loss ? 0 : search.few_cycles;  // it is near
  } else {
    const bool loud = start == PointStart::kLargeVibration;
    search.start =
        static_start(system, target.mean_pinion_speed, 0, 0, loud ? kLargeVibrationDeflection : 0);
    search.try_contact_first = !loud;
  }
  return search;
}

/// Everything that follows from a response; its pieces with their contacts.
SolvedPieces fill_from_orbit(GearPairSystem& system, MeshGrids& grids, const PeriodicOrbit& orbit,
                             int steps_per_mesh_cycle, double mean_pinion_speed, PointResult& out) {
  out.settled = true;
  out.period_in_mesh_cycles = out.recorded_mesh_cycles = orbit.period;
  system.set_torques(orbit.torques);
  SolvedPieces solved =
      solved_pieces(system, grids.with_steps(steps_per_mesh_cycle), orbit.pieces, *orbit.contacts);
  ResponseRecord record(march_scales(system, mean_pinion_speed).torque /
                        system.mesh().mean_pinion_contact_radius());
  record_orbit(system, orbit, solved, record);
  record.fill(system.torques(), orbit.period, true, out);
  out.power_balance.stored = system.stored_energy(0, orbit.pieces.back().end.data()) -
                             system.stored_energy(0, orbit.pieces.front().start.data());
  out.section_state = system.to_section(orbit.pieces.front().start.data());
  out.statistics.contact_solutions = system.contact_solutions();
  return solved;
}

/// By shooting. Nothing where marching must decide.
std::optional<PointResult> solve_by_shooting(
    GearPairSystem& system, const FlankContactBatch& contacts, MeshGrids& grids,
    const OperatingTarget& target, const PointOptions& options, PointStart start,
    const std::optional<CarriedState>& from, const HistoryRequest& history_request,
    std::optional<Rattle>& rattle, std::optional<OrbitSensitivity>& sensitivity) {
  const std::optional<OrbitSearch> search = search_from(system, target, options, start, from);
  if (!search) return std::nullopt;
  MarchStatistics statistics;
  long cycles = 0;
  const std::optional<RefinedOrbit> refined =
      refine_orbit(system, contacts, grids, *search, statistics, cycles, rattle);
  if (!refined) return std::nullopt;
  const PeriodicOrbit& orbit = refined->orbit;

  PointResult out = empty_result(target, PointModel::kFull);
  out.method = SteadyStateMethod::kShooting;
  set_estimate(refined->estimated_error, out);
  const SolvedPieces solved = fill_from_orbit(system, grids, orbit, refined->steps_per_mesh_cycle,
                                              target.mean_pinion_speed, out);
  HistorySampler history(history_request);
  sample_orbit(system, orbit, solved, history);
  out.history = history.take();
  // With data at the torque an orbit's gear set depends on its torque, which is not differentiated.
  if (options.sensitivities && !system.options().load_dependent_mesh_data) {
    sensitivity = orbit_sensitivity(system, grids.with_steps(refined->steps_per_mesh_cycle),
                                    contacts, orbit,
                                    target.mean_pinion_speed, target.solve_wheel_torque);
  }
  out.statistics.right_hand_sides = statistics.right_hand_sides;
  out.statistics.accepted_steps = statistics.accepted_steps;
  out.statistics.rejected_steps = statistics.rejected_steps;
  out.statistics.events = statistics.events;
  out.statistics.periodicity_defect = orbit.defect;
  out.statistics.mesh_cycles = cycles;
  out.statistics.contact_solutions = system.contact_solutions();
  out.statistics.largest_multiplier =
      refined->marched_multiplier ? *refined->marched_multiplier : orbit.map->largest_multiplier();
  return out;
}

/// With the march's reason where it would not begin either: a contact that is refused.
[[noreturn]] void refuse_shooting(GearPairSystem& system, const FlankContactBatch& contacts,
                                  MeshGrids& grids, const OperatingTarget& target,
                                  const PointOptions& options) {
  system.set_torques(target.torques);
  point_start(system, contacts, grids, target, options, PointStart::kQuasiStatic);
  throw Refusal(
      "NOT_FOUND_BY_SHOOTING",
      "method = SHOOTING finds no response, or none that surely attracts, at a mean "
      "pinion speed of " +
          number_text(target.mean_pinion_speed) + " rad/s and " +
          (target.solve_wheel_torque ? "a pinion torque of " + number_text(target.torques.pinion)
                                     : "a wheel torque of " + number_text(target.torques.wheel)) +
          " N m; AUTOMATIC or MARCH may");
}

PointResult quasi_static_result(GearPairSystem& system, MeshGrids& grids,
                                const OperatingTarget& target, const PointOptions& options,
                                QuasiStaticAnswer& answer) {
  PointResult out = empty_result(target, PointModel::kQuasiStatic);
  set_estimate(answer.estimated_error, out);
  const QuasiStatic& solution = answer.solution;
  fill_from_orbit(system, grids, solution.orbit, solution.steps_per_mesh_cycle,
                  target.mean_pinion_speed, out);
  // Speeds are taken as they follow each other, and the unknown torque from the mean power: neither
  // dampers nor what eq 2 leaves out take anything.
  PowerBalance& balance = out.power_balance;
  balance.shaft_damping = balance.mesh_damping = balance.parametric = 0;
  HistorySampler history(options.history);
  const QuasiStaticRequest request = quasi_static_request(target, options);
  sample_quasi_static(system, answer.solution, target.mean_pinion_speed, history,
                      request.interrupted);
  throw_if_refused(system);
  out.history = history.take();
  out.statistics.contact_solutions = system.contact_solutions();
  return out;
}

/// By the caller's choice: also where its error cannot be told.
PointResult solve_quasi_static_point(GearPairSystem& system, const FlankContactBatch& contacts,
                                     MeshGrids& grids, const OperatingTarget& target,
                                     const PointOptions& options) {
  auto answer = answer_quasi_statically(system, contacts, grids, target, options);
  throw_if_refused(system);
  if (!answer) {
    throw Refusal("NO_QUASI_STATIC_EQUILIBRIUM",
                  "load and friction of the quasi-static model do not settle");
  }
  return quasi_static_result(system, grids, target, options, *answer);
}

/// Returns the reason why a point has no sensitivities although its options include them.
std::string why_no_sensitivities(const Scene& scene, const PointResult& result) {
  if (scene.options.load_dependent_mesh_data) {
    return "figures are not differentiated with mesh data that depend on the torque";
  }
  if (result.model != PointModel::kFull) {
    return "figures of the quasi-static model are not differentiated; the full model is";
  }
  if (result.method == SteadyStateMethod::kMarch) {
    return "figures of a marched response are not differentiated; those found by shooting are";
  }
  return "the point is at a fold of its branch, or a contact neither slides nor entrains: there "
         "the "
         "figures have no derivatives";
}

}  // namespace

PointResult solve_operating_point(const Scene& scene, const OperatingCondition& condition,
                                  const PointOptions& options,
                                  std::shared_ptr<PreparedGearSet> gear_set) {
  PreparedScene prepared(scene, std::move(gear_set));
  return solve_prepared_point(prepared, condition, options);
}

PointResult solve_prepared_point(PreparedScene& prepared, const OperatingCondition& condition,
                                 const PointOptions& options) {
  const Scene& scene = prepared.scene();
  const FlankContactBatch& contacts = prepared.contacts();
  const OperatingTarget target = target_of(scene, condition);

  // One response from one start. With mesh data at the torque, the torque is iterated.
  const auto respond = [&](PointStart start, const std::optional<CarriedState>& carried,
                           const HistoryRequest& history) {
    std::optional<CarriedState> from = carried;
    double data_torque = target.torques.pinion;
    SolverStatistics spent;
    for (int pass = 0;; ++pass) {
      std::optional<PreparedGearSet> at_data_torque;
      if (scene.options.load_dependent_mesh_data) {
        at_data_torque.emplace(at_torque(scene.gear_set, data_torque), scene.solid, scene.options);
      }
      PreparedGearSet& gear_set = at_data_torque ? *at_data_torque : prepared.gear_set();
      GearPairSystem system(gear_set.mesh(), contacts.model(), gear_set.gear_set().dynamics,
                            scene.options);
      system.set_torques(target.torques);
      const bool last_pass = !scene.options.load_dependent_mesh_data || pass >= 12;
      PointResult result;
      MeshGrids& grids = gear_set.grids();
      std::optional<QuasiStaticAnswer> chosen;
      std::optional<Rattle> rattle;
      std::optional<OrbitSensitivity> sensitivity;
      if (options.model == PointModel::kQuasiStatic) {
        result = solve_quasi_static_point(system, contacts, grids, target, options);
      } else if (may_choose(options, from) &&
                 (chosen = choose_quasi_static(system, contacts, gear_set, target, options))) {
        result = quasi_static_result(system, grids, target, options, *chosen);
      } else if (std::optional<PointResult> shot;
                 options.method != SteadyStateMethod::kMarch &&
                 (shot = solve_by_shooting(system, contacts, grids, target, options, start, from,
                                           history, rattle, sensitivity))) {
        result = *std::move(shot);
        if (sensitivity) {
          result.sensitivities = point_sensitivities(
              scene, condition, {result.pinion_torque, result.wheel_torque}, *sensitivity);
        }
      } else if (options.method == SteadyStateMethod::kShooting) {
        refuse_shooting(system, contacts, grids, target, options);
      } else {
        // Together they are solved to 1e-10.
        if (march_tolerance(options) >= 1e-9) system.solve_together(&contacts);
        const MarchPlan plan =
            plan_march(system, contacts, grids, target, options, start, from, rattle);
        result = solve_by_marching(system, target, options, plan, history);
      }
      result.statistics.mesh_cycles += spent.mesh_cycles;
      result.statistics.right_hand_sides += spent.right_hand_sides;
      result.statistics.contact_solutions += spent.contact_solutions;
      result.statistics.accepted_steps += spent.accepted_steps;
      result.statistics.rejected_steps += spent.rejected_steps;
      result.statistics.events += spent.events;
      const double change = std::abs(result.pinion_torque - data_torque);
      if (last_pass || change <= 1e-10 * std::abs(result.pinion_torque)) return result;
      spent = result.statistics;
      data_torque = result.pinion_torque;
      if (chosen) continue;  // it starts anew
      from = carried_from(result);
    }
  };

  PointResult result = respond(options.start, options.carried_state, options.history);
  if (options.probe_coexisting_response && options.model != PointModel::kQuasiStatic) {
    for (const PointStart start : {PointStart::kQuasiStatic, PointStart::kLargeVibration}) {
      const PointResult other = respond(start, std::nullopt, {});
      const double span =
          result.dynamic_transmission_error.maximum - result.dynamic_transmission_error.minimum;
      const double difference = std::abs(other.dynamic_transmission_error.minimum -
                                         result.dynamic_transmission_error.minimum) +
                                std::abs(other.dynamic_transmission_error.maximum -
                                         result.dynamic_transmission_error.maximum);
      if (!other.settled || !result.settled || difference <= 1e-3 * span) continue;
      result.coexisting_response = CoexistingResponse{other.inefficiency_rms.value_or(0),
                                                      other.inefficiency_energy_mean.value_or(0),
                                                      other.pinion_torque,
                                                      other.dynamic_transmission_error.minimum,
                                                      other.dynamic_transmission_error.maximum,
                                                      other.contact_loss};
      break;
    }
  }
  const double multiplier = result.statistics.largest_multiplier;
  if (multiplier > 0 && result.period_in_mesh_cycles > 0) {
    const double period = result.period_in_mesh_cycles * 2 * std::numbers::pi /
                          (scene.gear_set.pinion_teeth * result.mean_pinion_speed);
    result.statistics.slowest_decay_rate = -std::log(multiplier) / period;
  }
  std::vector<RangeWarning> of_the_march = std::move(result.warnings);
  result.warnings = range_warnings(scene, result);
  std::move(of_the_march.begin(), of_the_march.end(), std::back_inserter(result.warnings));
  if (auto unused = unused_march_tolerance(options, result)) {
    result.warnings.push_back(*std::move(unused));
  }
  if (options.sensitivities && !result.sensitivities) {
    result.warnings.push_back({"NO_SENSITIVITIES", why_no_sensitivities(scene, result)});
  }
  return result;
}

namespace {

/// As pinned or as chosen. Nothing where the full model must answer, or nothing can.
std::optional<QuasiStaticAnswer> quasi_static_for(GearPairSystem& system,
                                                  const FlankContactBatch& contacts,
                                                  PreparedGearSet& gear_set,
                                                  const OperatingTarget& target,
                                                  const PointOptions& options) {
  if (options.model == PointModel::kQuasiStatic && system.torques().pinion != 0) {
    return answer_quasi_statically(system, contacts, gear_set.grids(), target, options);
  }
  if (!may_choose(options, std::nullopt)) return std::nullopt;
  return choose_quasi_static(system, contacts, gear_set, target, options);
}

PointFigures figures_of(const GearPairSystem& system, const PeriodicOrbit& orbit,
                        double estimated_error, const OperatingTarget& target) {
  PointFigures out;
  const OrbitFigures& f = orbit.figures;
  const double turned = orbit.period * system.cycle_angle();
  const double torque =
      input_torque(orbit.torques, static_cast<double>(system.mesh().pinion_teeth()) /
                                      static_cast<double>(system.mesh().gear_teeth()));
  out.pinion_torque = orbit.torques.pinion;
  out.wheel_torque = orbit.torques.wheel;
  out.inefficiency_rms = 100 * f.loss_rms / torque;
  out.inefficiency_energy_mean = 100 * f.loss_energy / (torque * turned);
  out.mesh_loss_power = f.loss_energy * target.mean_pinion_speed / turned;
  out.dte_minimum = f.dte_minimum;
  out.dte_maximum = f.dte_maximum;
  out.contact_loss = orbit.contact_loss;
  out.settled = true;
  out.period_in_mesh_cycles = orbit.period;
  set_estimate(estimated_error, out);
  out.contact_solutions = system.contact_solutions();
  out.model = PointModel::kFull;
  return out;
}

std::optional<ContactSummary> contact_summary(const PointResult& r) {
  if (r.film_ratio.maximum == 0) return std::nullopt;
  return ContactSummary{
      r.film_ratio.minimum,        r.film_ratio.mean,          r.contact_temperature.maximum,
      r.contact_temperature.mean,  r.viscous_loss_power,       r.boundary_loss_power,
      r.friction_coefficient.mean, r.maximum_pressure.maximum, r.flash_temperature_rise.maximum};
}

/// The contact summary of a response on the grid of `steps` steps.
std::optional<ContactSummary> contact_summary_of(GearPairSystem& system, MeshGrids& grids,
                                                 const PeriodicOrbit& orbit, int steps,
                                                 const OperatingTarget& target) {
  PointResult record = empty_result(target, PointModel::kFull);
  fill_from_orbit(system, grids, orbit, steps, target.mean_pinion_speed, record);
  return contact_summary(record);
}

enum class StepErrors { kByShorterSteps, kByReference };

PointFigures figures_at(PreparedScene& prepared, const OperatingCondition& condition,
                        const PointOptions& options, StepErrors step_errors) {
  const Scene& scene = prepared.scene();
  const OperatingTarget target = target_of(scene, condition);
  PreparedGearSet& gear_set = prepared.gear_set();
  PointOptions plain = options;
  plain.carried_state.reset();
  plain.probe_coexisting_response = false;
  plain.history = {};
  if (options.method == SteadyStateMethod::kAutomatic && !scene.options.load_dependent_mesh_data) {
    const FlankContactBatch& contacts = prepared.contacts();
    GearPairSystem system(gear_set.mesh(), contacts.model(), gear_set.gear_set().dynamics,
                          scene.options);
    system.set_torques(target.torques);
    if (const auto chosen = quasi_static_for(system, contacts, gear_set, target, plain)) {
      PointFigures figures =
          figures_of(system, chosen->solution.orbit, chosen->estimated_error, target);
      figures.model = PointModel::kQuasiStatic;
      if (options.contact_summary) {
        const QuasiStatic& solution = chosen->solution;
        figures.contact = contact_summary_of(system, gear_set.grids(), solution.orbit,
                                             solution.steps_per_mesh_cycle, target);
      }
      return figures;
    }
    if (options.model == PointModel::kAutomatic)
      plain.model = PointModel::kFull;  // it is found out
    std::optional<OrbitSearch> search;
    if (plain.model != PointModel::kQuasiStatic) {
      search = search_from(system, target, plain, plain.start, std::nullopt);
    }
    MarchStatistics statistics;
    long cycles = 0;
    std::optional<RefinedOrbit> found;
    if (search) {
      if (step_errors == StepErrors::kByReference) {
        search->references = &gear_set.reference_orbits();
      }
      std::optional<Rattle> rattle;
      found = refine_orbit(system, contacts, gear_set.grids(), *search, statistics, cycles, rattle);
    }
    if (found) {
      const PeriodicOrbit& orbit = found->orbit;
      const int steps = found->steps_per_mesh_cycle;
      PointFigures figures = figures_of(system, orbit, found->estimated_error, target);
      if (options.contact_summary) {
        figures.contact = contact_summary_of(system, gear_set.grids(), orbit, steps, target);
      }
      if (options.sensitivities) {
        const auto sensitivity = orbit_sensitivity(
            system, gear_set.grids().with_steps(steps), contacts,
            orbit, target.mean_pinion_speed, target.solve_wheel_torque);
        if (sensitivity) {
          figures.sensitivities =
              point_sensitivities(scene, condition, orbit.torques, *sensitivity);
        }
      }
      return figures;
    }
  }
  return main_figures(solve_prepared_point(prepared, condition, plain));
}

}  // namespace

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
          contact_summary(r),
          r.sensitivities};
}

PointFigures solve_point_figures(PreparedScene& prepared, const OperatingCondition& condition,
                                 const PointOptions& options) {
  return figures_at(prepared, condition, options, StepErrors::kByShorterSteps);
}

PointFigures screen_point(PreparedScene& prepared, const OperatingCondition& condition,
                          const PointOptions& options) {
  return figures_at(prepared, condition, options, StepErrors::kByReference);
}

}  // namespace tribodyn
