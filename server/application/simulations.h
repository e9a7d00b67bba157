#pragma once

#include <google/protobuf/empty.pb.h>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Checks and stores a simulation. When it returns, the simulation is on disk: QUEUED, or SUCCEEDED
/// if equal inputs have a result.
Outcome<v1::Simulation> create_simulation(Application& application,
                                          const v1::CreateSimulationRequest& request,
                                          const CallContext& call = {});
/// Returns a simulation, with its result if it has one and the view includes it.
Outcome<v1::Simulation> get_simulation(Application& application,
                                       const v1::GetSimulationRequest& request,
                                       const CallContext& call = {});
/// Returns true for a list that reads one page of rows by an index and no results.
bool is_short_list(const v1::ListSimulationsRequest& request);
/// Returns a page of simulations, by default the latest first and without results.
Outcome<v1::ListSimulationsResponse> list_simulations(Application& application,
                                                      const v1::ListSimulationsRequest& request,
                                                      const CallContext& call = {});

/// Cancels a simulation. When it returns, the simulation is CANCELLED on disk, unless it had ended
/// before.
Outcome<v1::Simulation> cancel_simulation(Application& application,
                                          const v1::CancelSimulationRequest& request,
                                          const CallContext& call = {});

/// Removes a simulation for good, with its result unless another simulation shares the result.
Outcome<google::protobuf::Empty> delete_simulation(Application& application,
                                                   const v1::DeleteSimulationRequest& request,
                                                   const CallContext& call = {});

/// Changes the display name or the labels of a simulation. Returns it without its result.
Outcome<v1::Simulation> update_simulation(Application& application,
                                          const v1::UpdateSimulationRequest& request,
                                          const CallContext& call = {});

// Protect a simulation from removal, and end the protection.
Outcome<v1::Simulation> pin_simulation(Application& application,
                                       const v1::PinSimulationRequest& request,
                                       const CallContext& call = {});
Outcome<v1::Simulation> unpin_simulation(Application& application,
                                         const v1::UnpinSimulationRequest& request,
                                         const CallContext& call = {});

}  // namespace tribodyn::server
