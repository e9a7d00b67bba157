#pragma once

#include <string>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"

namespace tribodyn::server {

/// Returns the stored simulation. Returns INVALID_ARGUMENT if `name` does not have the form of a
/// name, and NOT_FOUND if there is no such simulation.
Outcome<StoredSimulation> find_simulation(Application& application, const std::string& name,
                                          const CallContext& call);

/// Returns NOT_FOUND for the name of a simulation.
google::rpc::Status does_not_exist(const std::string& name);

}  // namespace tribodyn::server
