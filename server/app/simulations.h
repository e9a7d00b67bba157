#pragma once

#include "server/app/application.h"
#include "server/app/outcome.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Accepts a simulation: checked, on disk and QUEUED when this returns.
Outcome<v1::Simulation> create_simulation(Application& application,
                                          const v1::CreateSimulationRequest& request);
/// With its result when it has succeeded.
Outcome<v1::Simulation> get_simulation(Application& application,
                                       const v1::GetSimulationRequest& request);
/// Newest first, without results.
Outcome<v1::ListSimulationsResponse> list_simulations(Application& application,
                                                      const v1::ListSimulationsRequest& request);
/// CANCELLED on disk when this returns, unless it had ended before.
Outcome<v1::Simulation> cancel_simulation(Application& application,
                                          const v1::CancelSimulationRequest& request);

}  // namespace tribodyn::server
