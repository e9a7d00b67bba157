#pragma once

#include <grpcpp/impl/codegen/service_type.h>

#include <memory>
#include <vector>

#include "server/application/call_dispatcher.h"
#include "server/application/live_streams.h"

namespace tribodyn::server {

/// Returns gRPC services with all methods of the method table. The dispatcher, which must outlive
/// the services, answers their calls; `live` keeps their open streams.
std::vector<std::unique_ptr<grpc::Service>> grpc_services(CallDispatcher& dispatcher,
                                                          const std::shared_ptr<LiveStreams>& live);

}  // namespace tribodyn::server
