#pragma once

#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

/// Makes of a result what SIMULATION_VIEW_SUMMARY holds of it: each point has a summary in place of
/// its result, and the assumptions are left out.
void summarise(v1::SimulationResult& result);

}  // namespace tribodyn::server
