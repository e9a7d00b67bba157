#include "server/application/request_limits.h"

#include "tribodyn/v1/limits.pb.h"

namespace tribodyn::server {

std::size_t maximum_request_bytes(const google::protobuf::MethodDescriptor& method) {
  const auto& options = method.options();
  if (!options.HasExtension(v1::max_request_bytes)) return kUsualRequestBytes;
  return static_cast<std::size_t>(options.GetExtension(v1::max_request_bytes));
}

}  // namespace tribodyn::server
