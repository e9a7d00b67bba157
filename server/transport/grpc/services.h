#pragma once

#include <grpcpp/impl/codegen/service_type.h>

#include <chrono>
#include <memory>
#include <vector>

#include "server/application/application.h"
#include "server/transport/grpc/live_streams.h"

namespace tribodyn::server {

/// How long a method may take, whatever deadline its client sets. A unary one answers
/// DEADLINE_EXCEEDED; so does a stream, whether its client reads it or not: a simulation takes
/// longer than one watch may last, and its client watches on. A stream is cut off earlier when its
/// client takes nothing of a message for `unread`.
struct TimeLimits {
  std::chrono::milliseconds call = std::chrono::seconds(30);
  std::chrono::milliseconds stream = std::chrono::hours(1);
  std::chrono::milliseconds unread = std::chrono::minutes(1);
};

/// The gRPC services of tribodyn.v1: a thin shell, one line a method, over server/app. Unary
/// methods run on gRPC's threads, except the changes of simulations, of which thousands may wait
/// for the disk at a time. `application` and `live` must outlive them. Throws std::logic_error if a
/// method of the contract has no body.
std::vector<std::unique_ptr<grpc::Service>> grpc_services(Application& application,
                                                          LiveStreams& live,
                                                          const TimeLimits& limits);

}  // namespace tribodyn::server
