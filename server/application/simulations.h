#pragma once

#include <google/protobuf/empty.pb.h>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Accepts a simulation: checked, on disk and QUEUED when this returns.
Outcome<v1::Simulation> create_simulation(Application& application,
                                          const v1::CreateSimulationRequest& request,
                                          const CallContext& call = {});
/// With its result when it has succeeded.
Outcome<v1::Simulation> get_simulation(Application& application,
                                       const v1::GetSimulationRequest& request,
                                       const CallContext& call = {});
/// A page, by default newest first and without results.
Outcome<v1::ListSimulationsResponse> list_simulations(Application& application,
                                                      const v1::ListSimulationsRequest& request,
                                                      const CallContext& call = {});
/// CANCELLED on disk when this returns, unless it had ended before.
Outcome<v1::Simulation> cancel_simulation(Application& application,
                                          const v1::CancelSimulationRequest& request,
                                          const CallContext& call = {});

/// Removes it for good, with its result unless another simulation shares that.
Outcome<google::protobuf::Empty> delete_simulation(Application& application,
                                                   const v1::DeleteSimulationRequest& request,
                                                   const CallContext& call = {});

/// Changes its display name or labels. Answers without its result.
Outcome<v1::Simulation> update_simulation(Application& application,
                                          const v1::UpdateSimulationRequest& request,
                                          const CallContext& call = {});

/// Keeps it for good, and gives it up again.
Outcome<v1::Simulation> pin_simulation(Application& application,
                                       const v1::PinSimulationRequest& request,
                                       const CallContext& call = {});
Outcome<v1::Simulation> unpin_simulation(Application& application,
                                         const v1::UnpinSimulationRequest& request,
                                         const CallContext& call = {});

}  // namespace tribodyn::server
