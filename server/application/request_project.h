#pragma once

#include <google/protobuf/message.h>

#include <optional>
#include <string>

#include "google/rpc/status.pb.h"
#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/contract/violations.h"

namespace tribodyn::server {

/// Returns the project that a request is about, and removes the project from every name of the
/// request, so that the use cases see relative names only (resource_names.h). The project is that
/// of `parent`, or else that of the first name with a project that the request is about, or else
/// `default`. Adds a violation for each name of another project, and for a parent that is no name
/// of a project.
std::string take_project(google::protobuf::Message& request, Violations& violations);

/// Sets the project of a call as take_project() does. Returns PERMISSION_DENIED if the grant of the
/// call does not cover the project, which may exist or not; INVALID_ARGUMENT for a request about
/// two projects; NOT_FOUND for an unknown project; else nullopt. Reads no row of the store.
std::optional<google::rpc::Status> enter_project(Application& application,
                                                 google::protobuf::Message& request,
                                                 CallContext& context);

}  // namespace tribodyn::server
