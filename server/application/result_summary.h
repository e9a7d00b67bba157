#pragma once

#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

/// Reduces a result to SIMULATION_VIEW_SUMMARY: replaces the result of each point by its summary
/// and removes the assumptions.
void summarise(v1::SimulationResult& result);

}  // namespace tribodyn::server
