#pragma once

#include <cstdint>

#include "server/simulation/simulation_inputs.h"
#include "server/storage/stored_simulation.h"
#include "tribodyn/internal/v1/tasks.pb.h"

namespace tribodyn::server {

/// The wire form of an attempt to compute the inputs.
internal::v1::ComputeTask compute_task(const SimulationInputs& inputs, std::int64_t id, int attempt,
                                       const std::string& input_hash, bool force);

/// The inputs of a task, except for the request as it came. Throws Refusal TASK_UNREADABLE if a
/// resource cannot be parsed.
SimulationInputs inputs_of(const internal::v1::ComputeTask& task);

/// Bytes of the histories that a study asks for.
std::int64_t history_bytes(const v1::Simulation& effective);

/// The history of a result, moved out column by column, so that no history is in memory twice.
std::vector<StoredColumn> take_history(internal::v1::ComputeResult& result);

}  // namespace tribodyn::server
