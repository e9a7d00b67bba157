#pragma once

#include <string>

#include "server/contract/violations.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// All that a client stated in a request to create a simulation, except its request_id and whether
/// it is only to be checked: two requests are the same when their texts are.
std::string request_text(const v1::Simulation& requested, bool force);

/// Path of the first value in which two such texts differ.
std::string first_difference(const std::string& one, const std::string& other);

/// A request_id is printable ASCII without spaces, at most kMaximumRequestIdLength bytes.
void check_request_id(const std::string& request_id, Violations& violations);

inline constexpr int kMaximumRequestIdLength = 100;

}  // namespace tribodyn::server
