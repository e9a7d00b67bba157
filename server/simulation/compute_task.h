#pragma once

#include <cstdint>

#include "server/simulation/simulation_inputs.h"
#include "server/storage/stored_simulation.h"
#include "tribodyn/internal/v1/tasks.pb.h"

namespace tribodyn::server {

/// Returns the message that asks an executor to compute an attempt.
internal::v1::ComputeTask compute_task(const SimulationInputs& inputs, std::int64_t id, int attempt,
                                       const std::string& input_hash, bool force);

/// Returns the inputs of a task, without SimulationInputs::requested. Throws Refusal
/// TASK_UNREADABLE if a resource cannot be parsed.
SimulationInputs inputs_of(const internal::v1::ComputeTask& task);

/// Returns the size of the history that a study requests [bytes].
std::int64_t history_bytes(const v1::Simulation& effective);

/// Moves the history out of a result column by column, so that memory holds one column twice at
/// most.
std::vector<StoredColumn> take_history(internal::v1::ComputeResult& result);

}  // namespace tribodyn::server
