#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "server/simulation/prepared_gear_sets.h"
#include "server/simulation/simulation_inputs.h"
#include "server/storage/store.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

/// The core's studies; tests put their own in place.
struct StudyFunctions {
  std::function<PointResult(const Scene&, const OperatingCondition&, const PointOptions&,
                            std::shared_ptr<PreparedGearSet>)>
      solve_operating_point = tribodyn::solve_operating_point;
  std::function<std::vector<SweepPoint>(
      const Scene&, std::vector<double>, double, const SweepOptions&,
      const std::function<void(const SweepPoint&)>&, const std::shared_ptr<PreparedGearSet>&)>
      sweep_speed = tribodyn::sweep_speed;
};

/// What a simulation leaves behind.
struct Computed {
  v1::SimulationResult result;
  std::vector<StoredColumn> history;
};

/// The stage in words, made where they are wanted: a point takes a tenth of a millisecond and
/// reports ten times.
using StageText = std::function<std::string()>;

/// Told the fraction done in [0, 1] and the stage; false asks to stop.
using ReportProgress = std::function<bool(double fraction, const StageText& stage)>;

/// What the core answers: a point, or a curve in ascending speed.
using Solved = std::variant<PointResult, std::vector<SweepPoint>>;

/// Runs the study with a gear set of `gear_sets`. Throws Refusal, Cancelled, or what the core
/// throws.
Solved solve(const SimulationInputs& inputs, const StudyFunctions& studies,
             PreparedGearSets& gear_sets, const ReportProgress& report);

/// Makes the result: points, hash (`key`: of the inputs), versions, but no assumptions, which
/// belong to the simulation and not to its numbers. Throws Refusal where a number is not finite.
Computed to_result(const SimulationInputs& inputs, const ResultKey& key, Solved solved);

/// Both in one, with a gear set that is prepared for it.
Computed compute(const SimulationInputs& inputs, const ResultKey& key,
                 const StudyFunctions& studies, const ReportProgress& report);

}  // namespace tribodyn::server
