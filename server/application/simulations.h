#pragma once

#include <string>

#include "server/application/application.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Who calls.
struct Caller {
  std::string client = {};  ///< shares the processors with the others
};

/// Accepts a simulation: checked, on disk and QUEUED when this returns.
Outcome<v1::Simulation> create_simulation(Application& application,
                                          const v1::CreateSimulationRequest& request,
                                          const Caller& caller = {});
/// With its result when it has succeeded.
Outcome<v1::Simulation> get_simulation(Application& application,
                                       const v1::GetSimulationRequest& request);
/// A page, by default newest first and without results.
Outcome<v1::ListSimulationsResponse> list_simulations(Application& application,
                                                      const v1::ListSimulationsRequest& request);
/// CANCELLED on disk when this returns, unless it had ended before.
Outcome<v1::Simulation> cancel_simulation(Application& application,
                                          const v1::CancelSimulationRequest& request);

/// Keeps it for good, and gives it up again.
Outcome<v1::Simulation> pin_simulation(Application& application,
                                       const v1::PinSimulationRequest& request);
Outcome<v1::Simulation> unpin_simulation(Application& application,
                                         const v1::UnpinSimulationRequest& request);

}  // namespace tribodyn::server
