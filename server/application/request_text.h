#pragma once

#include <string>

#include "server/contract/violations.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Returns everything that a client set in a CreateSimulationRequest, except request_id and
/// validate_only, as text. Two requests are equal if their texts are.
std::string request_text(const v1::Simulation& requested, bool force);

/// Returns the path of the first value in which two such texts differ; empty if they are equal.
std::string first_difference(const std::string& one, const std::string& other);

/// Adds a violation unless the request_id is printable ASCII without spaces of at most
/// kMaximumRequestIdLength bytes.
void check_request_id(const std::string& request_id, Violations& violations);

inline constexpr int kMaximumRequestIdLength = 100;

}  // namespace tribodyn::server
