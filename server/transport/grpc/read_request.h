#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <grpcpp/support/byte_buffer.h>

#include <optional>

#include "google/rpc/status.pb.h"

namespace tribodyn::server {

/// Reads the request of a call of `method` from its bytes, and lets go of the bytes. Returns
/// INVALID_ARGUMENT, without having parsed anything, if they are more than the method takes
/// (request_limits.h) or hold more than any acceptable request (wire_check.h), and if they are no
/// such message; else nullopt.
std::optional<google::rpc::Status> read_request(const google::protobuf::MethodDescriptor& method,
                                                grpc::ByteBuffer& bytes,
                                                google::protobuf::Message& request);

}  // namespace tribodyn::server
