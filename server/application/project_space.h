#pragma once

#include <optional>

#include "google/rpc/status.pb.h"
#include "server/application/application.h"
#include "server/application/call_context.h"

namespace tribodyn::server {

/// Returns the error of a project whose results and campaigns take all the bytes that it may have;
/// else nullopt.
std::optional<google::rpc::Status> project_full(Application& application, const CallContext& call);

/// Returns the error of a project whose simulations and campaigns that wait and run leave no room
/// for a further one of that cost [s of one processor]; else nullopt. Like project_full(), two
/// calls at the same time may both pass.
std::optional<google::rpc::Status> project_busy(Application& application, double cost_seconds,
                                                const CallContext& call);

}  // namespace tribodyn::server
