#pragma once

#include <string>
#include <vector>

#include "server/simulation/simulation_inputs.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

/// Every assumption a result rests on: each parameter of fluid, gear set (its series and tables by
/// block), surface and vehicle with value, unit, provenance and source, and what the request left
/// to defaults.
std::vector<v1::Assumption> assumptions(const SimulationInputs& inputs);

/// How lubricant and surface are known: what to know before relying on any result of these inputs.
std::vector<v1::RangeWarning> input_warnings(const SimulationInputs& inputs);

/// Both as a serialised v1::SimulationResult that holds nothing else.
std::string ledger(const SimulationInputs& inputs);

}  // namespace tribodyn::server
