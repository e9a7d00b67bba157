#pragma once

#include <grpcpp/impl/codegen/service_type.h>

#include <memory>
#include <vector>

#include "server/application/call_dispatcher.h"
#include "server/transport/grpc/live_streams.h"

namespace tribodyn::server {

/// The gRPC services of the method table: whatever it holds, the dispatcher answers. Both arguments
/// must outlive them.
std::vector<std::unique_ptr<grpc::Service>> grpc_services(CallDispatcher& dispatcher,
                                                          LiveStreams& live);

}  // namespace tribodyn::server
