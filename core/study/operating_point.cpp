#include "core/study/operating_point.h"

#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>

#include "core/study/point_by_marching.h"
#include "core/study/point_by_shooting.h"
#include "core/study/quasi_static_point.h"
#include "core/study/range_warnings.h"
#include "core/study/response_warnings.h"
#include "core/study/unused_tolerance.h"

namespace tribodyn {
namespace {

/// A response on given mesh data.
struct Response {
  PointResult result;
  bool is_chosen = false;  ///< by the quasi-static model, which PointModel::kAutomatic allows
};

/// By the first of the ways that the options allow and that finds one.
Response solve_response(const PointProblem& problem, const Scene& scene,
                        const OperatingCondition& condition, PointStart start,
                        const std::optional<CarriedState>& from, const HistoryRequest& history) {
  const PointOptions& options = problem.options;
  if (options.model == PointModel::kQuasiStatic) return {solve_quasi_static_point(problem)};
  if (may_choose(options, from)) {
    if (auto chosen = choose_quasi_static(problem)) {
      return {quasi_static_result(problem, *chosen), true};
    }
  }
  std::optional<SectionPoint> aperiodic;
  if (options.method != SteadyStateMethod::kMarch) {
    if (auto shot = solve_by_shooting(problem, start, from, history, aperiodic)) {
      PointResult& result = shot->result;
      if (shot->sensitivity) {
        result.sensitivities = point_sensitivities(
            scene, condition, {result.pinion_torque, result.wheel_torque}, *shot->sensitivity);
      }
      return {std::move(result)};
    }
  }
  if (options.method == SteadyStateMethod::kShooting || options.gives_up_early) {
    refuse_shooting(problem);
  }
  return {solve_by_marching(problem, start, from, history, aperiodic)};
}

/// A response from a start. With mesh data at the torque, the torque is iterated.
PointResult solve_from(PreparedScene& prepared, const OperatingCondition& condition,
                       const OperatingTarget& target, const PointOptions& options, PointStart start,
                       std::optional<CarriedState> from, const HistoryRequest& history) {
  constexpr int kMostPasses = 13;
  constexpr double kSameTorque = 1e-10;  // relative
  const Scene& scene = prepared.scene();
  const bool iterates = scene.options.load_dependent_mesh_data;
  double data_torque = target.torques.pinion;
  SolverWork spent;
  for (int pass = 1;; ++pass) {
    std::optional<PreparedGearSet> at_data_torque;
    if (iterates) {
      at_data_torque.emplace(at_torque(scene.gear_set, data_torque), scene.solid, scene.options);
    }
    PreparedGearSet& gear_set = at_data_torque ? *at_data_torque : prepared.gear_set();
    ContactTally tally;
    const PointProblem problem{prepared.contacts(), gear_set, target, options, tally};
    Response response = solve_response(problem, scene, condition, start, from, history);
    PointResult& result = response.result;
    result.statistics += spent;
    const double change = std::abs(result.pinion_torque - data_torque);
    if (!iterates || pass == kMostPasses ||
        change <= kSameTorque * std::abs(result.pinion_torque)) {
      if (result.settled) {
        if (auto other = coexistence_warning(problem, result.contact_loss)) {
          result.warnings.push_back(*std::move(other));
        }
      }
      return std::move(result);
    }
    spent = result.statistics;
    data_torque = result.pinion_torque;
    if (!response.is_chosen) from = carried_from(result);
  }
}

/// The first response of both starts that differs from a result by more than 1e-3 of the swing of
/// its transmission error.
std::optional<CoexistingResponse> coexisting_response(PreparedScene& prepared,
                                                      const OperatingCondition& condition,
                                                      const OperatingTarget& target,
                                                      const PointOptions& options,
                                                      const PointResult& result) {
  const Extremes& dte = result.dynamic_transmission_error;
  for (const PointStart start : {PointStart::kQuasiStatic, PointStart::kLargeVibration}) {
    const PointResult other =
        solve_from(prepared, condition, target, options, start, std::nullopt, {});
    const Extremes& other_dte = other.dynamic_transmission_error;
    const double difference =
        std::abs(other_dte.minimum - dte.minimum) + std::abs(other_dte.maximum - dte.maximum);
    if (!other.settled || !result.settled || difference <= 1e-3 * (dte.maximum - dte.minimum)) {
      continue;
    }
    return CoexistingResponse{other.inefficiency_rms.value_or(0),
                              other.inefficiency_energy_mean.value_or(0),
                              other.pinion_torque,
                              other_dte.minimum,
                              other_dte.maximum,
                              other.contact_loss};
  }
  return std::nullopt;
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
         "the figures have no derivatives";
}

void add_warnings(PreparedScene& prepared, const PointOptions& options, PointResult& result) {
  const Scene& scene = prepared.scene();
  std::vector<RangeWarning> of_the_response = std::move(result.warnings);
  const RangeFigures figures = range_figures(prepared, result);
  result.inlet_heating_factor = figures.inlet_heating_factor;
  result.warnings = range_warnings(scene, figures);
  std::move(of_the_response.begin(), of_the_response.end(), std::back_inserter(result.warnings));
  if (auto unused = unused_march_tolerance(options, result)) {
    result.warnings.push_back(*std::move(unused));
  }
  if (options.sensitivities && !result.sensitivities) {
    result.warnings.push_back({"NO_SENSITIVITIES", why_no_sensitivities(scene, result)});
  }
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
  const OperatingTarget target = target_of(scene, condition);
  PointResult result = solve_from(prepared, condition, target, options, options.start,
                                  options.carried_state, options.history);
  if (options.probe_coexisting_response && options.model != PointModel::kQuasiStatic) {
    result.coexisting_response = coexisting_response(prepared, condition, target, options, result);
  }
  const double multiplier = result.statistics.largest_multiplier;
  if (multiplier > 0 && result.period_in_mesh_cycles > 0) {
    const double period = result.period_in_mesh_cycles * 2 * std::numbers::pi /
                          (scene.gear_set.pinion_teeth * result.mean_pinion_speed);
    result.statistics.slowest_decay_rate = -std::log(multiplier) / period;
  }
  add_warnings(prepared, options, result);
  return result;
}

}  // namespace tribodyn
