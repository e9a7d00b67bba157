#pragma once

#include <string>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"

namespace tribodyn::server {

/// The stored simulation of that name; INVALID_ARGUMENT for what is no name, or NOT_FOUND.
Outcome<StoredSimulation> find_simulation(Application& application, const std::string& name,
                                          const CallContext& call);

/// NOT_FOUND for the name of a simulation.
google::rpc::Status does_not_exist(const std::string& name);

}  // namespace tribodyn::server
