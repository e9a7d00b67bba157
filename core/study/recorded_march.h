#pragma once

#include <functional>

#include "core/dynamics/steady_state.h"
#include "core/study/history_sampler.h"
#include "core/study/response_record.h"

namespace tribodyn {

/// Marches a steady state once more over `cycles` mesh cycles and records it; goes on beyond them
/// as far as the history asks. Leaves the system at the end of the march, with the steady state's
/// torques. Throws as march_mesh_cycle does, and Cancelled when `progress` returns false.
void record_response(GearPairSystem& system, const SteadyState& steady, int cycles,
                     const MarchOptions& options, const MarchScales& scales, ResponseRecord& record,
                     HistorySampler& history, SolverStatistics& statistics,
                     const std::function<bool(double)>& progress);

}  // namespace tribodyn
