#pragma once

#include <memory>
#include <optional>

#include "google/rpc/status.pb.h"
#include "server/application/application.h"
#include "server/application/call_context.h"

namespace tribodyn::server {

/// Returns the error of a project whose results and campaigns take all the bytes that it may have;
/// else nullopt.
std::optional<google::rpc::Status> project_full(Application& application, const CallContext& call);

/// Room in the quotas of processor hours, held until the work that takes it is written.
struct WorkPlace {
  std::shared_ptr<Allowance> of_project;
  std::shared_ptr<void> in_project = nullptr;
  std::shared_ptr<void> of_principal = nullptr;
};

/// Takes room for a simulation or campaign of that cost [s of one processor] in the quotas of its
/// project and of the principal that calls: simulations and campaigns that wait and run count.
/// Returns the error of the quota without room; else nullopt.
std::optional<google::rpc::Status> take_hours(Application& application, double cost_seconds,
                                              const CallContext& call, WorkPlace& place);

}  // namespace tribodyn::server
