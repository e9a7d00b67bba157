#pragma once

#include <optional>
#include <string>

#include "server/storage/maintenance.h"

namespace tribodyn::server {

/// HashInputs of check_database: the hash of a stored simulation's inputs, computed again from its
/// request and its revisions. Empty text when they are not acceptable any more.
std::optional<std::string> hash_stored_inputs(const v1::Simulation& request,
                                              const std::string& model_version,
                                              const FindRevision& find);

}  // namespace tribodyn::server
