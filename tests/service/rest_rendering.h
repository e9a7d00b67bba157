#pragma once

#include <google/protobuf/message.h>

#include <string>

#include "google/rpc/status.pb.h"
#include "server/transport/http/http_message.h"
#include "server/transport/http/http_routes.h"

namespace tribodyn::server {

/// Returns a request message as a client of REST sends it: verb, path, query and JSON body, by the
/// first route of the method whose path the message fits. Throws std::logic_error if none does.
HttpRequest rest_request(const HttpRoutes& routes, const Method& method,
                         const google::protobuf::Message& request);

/// Reads a message from JSON; every field of the text must exist. Throws std::logic_error.
void read_json(const std::string& text, google::protobuf::Message& out);

/// Returns the error in the body of an AIP-193 answer as google.rpc.Status, whose code is that of
/// its word "status".
google::rpc::Status error_of_json(const std::string& body);

}  // namespace tribodyn::server
