#pragma once

#include <optional>
#include <string>

#include "google/rpc/status.pb.h"
#include "server/transport/http/http_message.h"
#include "server/transport/http/http_routes.h"

namespace tribodyn::server {

/// The request message of a method in protobuf's binary form.
struct WrittenRequest {
  std::string wire;
  bool has_read_mask = false;  ///< the query has a read_mask that names fields
};

/// Writes the request message of a method: fields of the path, the query and the header If-Match
/// (the field "etag") over those of the JSON body; Last-Event-ID is the field that a stream resumes
/// after. No message is built from the body, so that the
/// dispatcher counts its elements before anything grows. Returns INVALID_ARGUMENT that names each
/// wrong parameter, or the place of the body that cannot be read.
std::optional<google::rpc::Status> write_request(const RouteMatch& route,
                                                 const HttpRequest& request, WrittenRequest& out);

}  // namespace tribodyn::server
