#include "server/simulation/compute.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iterator>
#include <new>
#include <string_view>

#include "core/refusal.h"
#include "core/version.h"
#include "server/contract/check_message.h"
#include "server/mapping/from_core.h"
#include "server/simulation/compute_task.h"
#include "server/simulation/result_key.h"

namespace tribodyn::server {
namespace {

/// Columns of a history that are infinite without a film, or for a surface at rest.
constexpr std::string_view kMayBeInfinite[] = {
    "flank_shear_rate_per_second", "flank_pinion_specific_sliding", "flank_gear_specific_sliding"};

std::string stage_of(const OperatingCondition& condition) {
  if (condition.kind == OperatingCondition::Kind::kPrescribedTorque) {
    return fmt::format("settling at {} N m and {} rad/s", condition.pinion_torque,
                       condition.pinion_speed);
  }
  return fmt::format("settling at {} km/h", kilometres_per_hour(condition.vehicle_speed));
}

/// Throws Refusal if a number of a history is not finite and may not be infinite.
void check_finite(const History& history) {
  for (std::size_t c = 0; c < history.values.size(); ++c) {
    const bool infinite_allowed =
        std::any_of(std::begin(kMayBeInfinite), std::end(kMayBeInfinite),
                    [&](std::string_view name) { return history.names[c].starts_with(name); });
    for (const double value : history.values[c]) {
      if (std::isnan(value) || (std::isinf(value) && !infinite_allowed)) {
        throw Refusal("RESULT_NOT_FINITE", "history column " + history.names[c] +
                                               " contains a number that is not finite");
      }
    }
  }
}

PointResult solve_point(const PointStudy& study, const Scene& scene,
                        const std::shared_ptr<PreparedGearSet>& gear_set,
                        const StudyFunctions& studies, const ReportProgress& report) {
  PointOptions options = study.options;
  const StageText stage = [&study] { return stage_of(study.condition); };
  options.progress = [&](double fraction) { return report(fraction, stage); };
  return studies.solve_operating_point(scene, study.condition, options, gear_set);
}

std::vector<SweepPoint> solve_curve(const CurveStudy& study, const Scene& scene,
                                    const std::shared_ptr<PreparedGearSet>& gear_set,
                                    const StudyFunctions& studies, const ReportProgress& report) {
  const bool down = study.options.direction == SweepDirection::kDown;
  const std::size_t count = study.vehicle_speeds.size();
  std::size_t done = 0;
  SweepOptions options = study.options;
  const StageText stage = [&] {
    const std::size_t now = std::min(done, count - 1);
    const double speed = study.vehicle_speeds[down ? count - 1 - now : now];
    return fmt::format("settling at {} km/h, point {} of {}", kilometres_per_hour(speed), now + 1,
                       count);
  };
  options.point.progress = [&](double fraction) { return report(fraction, stage); };
  const auto on_point = [&done](const SweepPoint&) { ++done; };
  return studies.sweep_speed(scene, study.vehicle_speeds, study.ascent_angle, options, on_point,
                             gear_set);
}

void add_point(PointResult& result, Computed& out) {
  *out.result.add_points() = to_curve_point(result);
  check_finite(result.history);
  for (std::size_t c = 0; c < result.history.names.size(); ++c) {
    out.result.add_history_columns(result.history.names[c]);
    out.result.set_history_rows(static_cast<std::int64_t>(result.history.values[c].size()));
    out.history.push_back({result.history.names[c], std::move(result.history.values[c])});
  }
}

void add_curve(const SimulationInputs& inputs, const std::vector<SweepPoint>& points,
               Computed& out) {
  for (const SweepPoint& point : points) *out.result.add_points() = to_curve_point(point);
  const v1::InefficiencyCurveStudy& curve = inputs.effective.inefficiency_curve();
  out.result.set_independent_points(curve.independent_points());
  if (!curve.independent_points()) out.result.set_direction(curve.direction());
}

}  // namespace

Solved solve(const SimulationInputs& inputs, const StudyFunctions& studies,
             PreparedGearSets& gear_sets, const ReportProgress& report) {
  const Scene physical = scene(inputs);
  const Study asked = study(inputs);
  const std::shared_ptr<PreparedGearSet> gear_set = gear_sets.take(inputs.gear_set, physical);
  Solved out;
  if (const auto* point = std::get_if<PointStudy>(&asked)) {
    out = solve_point(*point, physical, gear_set, studies, report);
  } else {
    out = solve_curve(std::get<CurveStudy>(asked), physical, gear_set, studies, report);
  }
  // An exception that ends the study may leave the gear set half prepared: then it is not given
  // back.
  gear_sets.give_back(inputs.gear_set, physical.options, gear_set);
  return out;
}

Computed to_result(const SimulationInputs& inputs, const ResultKey& key, Solved solved) {
  Computed out;
  if (auto* point = std::get_if<PointResult>(&solved)) {
    add_point(*point, out);
  } else {
    add_curve(inputs, std::get<std::vector<SweepPoint>>(solved), out);
  }
  const std::string bad = first_not_finite(out.result);
  if (!bad.empty()) throw Refusal("RESULT_NOT_FINITE", bad + " is not finite");
  out.result.set_model_version(key.model_version);
  out.result.set_input_hash(key.input_hash);
  out.result.set_platform(key.platform);
  return out;
}

double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

namespace {

void set_refusal(const std::string& reason, const std::string& message,
                 internal::v1::ComputeResult& out) {
  out.mutable_refusal()->set_reason(reason);
  out.mutable_refusal()->set_message(message);
}

void set_outcome(const internal::v1::ComputeTask& task, const StudyFunctions& studies,
                 PreparedGearSets& gear_sets, const ReportProgress& report,
                 internal::v1::ComputeResult& out) {
  const SimulationInputs inputs = inputs_of(task);
  const ResultKey key{task.input_hash(), kModelVersion, platform()};
  Computed computed = to_result(inputs, key, solve(inputs, studies, gear_sets, report));
  for (StoredColumn& column : computed.history) {
    internal::v1::HistoryColumn& added = *out.add_history();
    added.set_name(column.name);
    added.mutable_values()->Add(column.values.begin(), column.values.end());
    std::vector<double>().swap(column.values);
  }
  computed.result.SerializeToString(out.mutable_result());
}

}  // namespace

internal::v1::ComputeResult compute(const internal::v1::ComputeTask& task,
                                    const StudyFunctions& studies, PreparedGearSets& gear_sets,
                                    const ReportProgress& report) {
  const double begin = processor_seconds();
  internal::v1::ComputeResult out;
  out.set_simulation(task.simulation());
  out.set_attempt(task.attempt());
  out.set_model_version(kModelVersion);
  out.set_platform(platform());
  try {
    set_outcome(task, studies, gear_sets, report, out);
  } catch (const Cancelled&) {
    out.set_stopped(true);
  } catch (const Refusal& refusal) {
    set_refusal(refusal.reason(), refusal.what(), out);
  } catch (const std::bad_alloc&) {
    out.clear_history();
    set_refusal("OUT_OF_MEMORY", "not enough memory for this simulation", out);
  } catch (const std::exception& defect) {
    out.set_defect(defect.what());
  } catch (...) {
    out.set_defect("an exception of unknown type");
  }
  out.set_processor_seconds(processor_seconds() - begin);
  return out;
}

}  // namespace tribodyn::server
