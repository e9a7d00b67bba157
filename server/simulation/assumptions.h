#pragma once

#include <string>
#include <vector>

#include "server/simulation/simulation_inputs.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

/// Returns every assumption of a result: each parameter of lubricant, gear set (series and tables
/// as blocks), surface and vehicle with value, unit, provenance and source, and each default that
/// the request left unset.
std::vector<v1::Assumption> assumptions(const SimulationInputs& inputs);

/// Returns warnings about lubricant and surface that concern every result of these inputs.
std::vector<v1::RangeWarning> input_warnings(const SimulationInputs& inputs);

/// Returns assumptions, input warnings and limits as a serialised v1::SimulationResult without
/// other fields.
std::string serialised_assumptions(const SimulationInputs& inputs);

}  // namespace tribodyn::server
