#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "server/simulation/prepared_gear_sets.h"
#include "server/simulation/simulation_inputs.h"
#include "server/storage/store.h"
#include "tribodyn/internal/v1/tasks.pb.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

/// The studies of the core. Tests replace them.
struct StudyFunctions {
  std::function<PointResult(const Scene&, const OperatingCondition&, const PointOptions&,
                            std::shared_ptr<PreparedGearSet>)>
      solve_operating_point = tribodyn::solve_operating_point;
  std::function<std::vector<SweepPoint>(
      const Scene&, std::vector<double>, double, const SweepOptions&,
      const std::function<void(const SweepPoint&)>&, const std::shared_ptr<PreparedGearSet>&)>
      sweep_speed = tribodyn::sweep_speed;
};

/// Result and history of a computed simulation.
struct Computed {
  v1::SimulationResult result;
  std::vector<StoredColumn> history;
};

/// Returns the stage as text. It is a function because most reports are not shown: a point takes a
/// tenth of a millisecond and makes ten reports.
using StageText = std::function<std::string()>;

/// Receives the completed fraction in [0, 1] and the stage. Returns false to cancel the study.
using ReportProgress = std::function<bool(double fraction, const StageText& stage)>;

/// Answer of the core: a point, or a curve in ascending order of speed.
using Solved = std::variant<PointResult, std::vector<SweepPoint>>;

/// Runs the study with a prepared gear set of `gear_sets`. Throws Refusal, Cancelled, and
/// exceptions of the core.
Solved solve(const SimulationInputs& inputs, const StudyFunctions& studies,
             PreparedGearSets& gear_sets, const ReportProgress& report);

/// Converts the answer of the core to a result with the hash of `key` and the versions. Assumptions
/// are not included: they belong to the simulation, while several simulations may share a result.
/// Throws Refusal if a number is not finite.
Computed to_result(const SimulationInputs& inputs, const ResultKey& key, Solved solved);

/// Returns the processor time of this thread [s].
double processor_seconds();

/// Computes a task with a gear set of `gear_sets`. Throws nothing: refusals, defects and stops are
/// outcomes.
internal::v1::ComputeResult compute(const internal::v1::ComputeTask& task,
                                    const StudyFunctions& studies, PreparedGearSets& gear_sets,
                                    const ReportProgress& report);

}  // namespace tribodyn::server
