#pragma once

#include <grpcpp/impl/codegen/service_type.h>

#include <memory>
#include <vector>

#include "server/api/live_streams.h"
#include "server/app/application.h"

namespace tribodyn::server {

/// The gRPC services of tribodyn.v1: a thin shell, one line a method, over server/app. Unary
/// methods run where gRPC calls them, as none takes long, and end at their client's deadline or
/// after 30 s. `application` and `live` must outlive
/// them.
std::vector<std::unique_ptr<grpc::Service>> grpc_services(Application& application,
                                                          LiveStreams& live);

}  // namespace tribodyn::server
