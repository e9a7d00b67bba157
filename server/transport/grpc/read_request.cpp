#include "server/transport/grpc/read_request.h"

#include <fmt/format.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include "server/application/errors.h"
#include "server/application/request_limits.h"
#include "server/application/wire_check.h"

namespace tribodyn::server {

std::optional<google::rpc::Status> read_request(const google::protobuf::MethodDescriptor& method,
                                                grpc::ByteBuffer& bytes,
                                                google::protobuf::Message& request) {
  const std::size_t size = bytes.Length();
  const std::size_t maximum = maximum_request_bytes(method);
  if (size > maximum) {
    return invalid({{"", fmt::format("the request has {} bytes; allowed: at most {} for {}", size,
                                     maximum, method.name())}});
  }
  Violations violations;
  {
    grpc::ProtoBufferReader reader(&bytes);
    check_wire(reader, static_cast<int>(size), *method.input_type(), violations);
  }
  if (!violations.empty()) return invalid(violations);
  grpc::ProtoBufferReader reader(&bytes);
  if (!request.ParseFromZeroCopyStream(&reader)) {
    return invalid({unreadable_violation(*method.input_type())});
  }
  bytes.Clear();
  return std::nullopt;
}

}  // namespace tribodyn::server
