#pragma once

#include <optional>
#include <string>

#include "server/storage/maintenance.h"

namespace tribodyn::server {

/// Computes the input hash of a stored simulation from its request and its revisions, for
/// check_database(). Returns an empty text if the inputs are no longer valid, and nullopt if they
/// are of another version of the model.
std::optional<std::string> hash_stored_inputs(const v1::Simulation& request,
                                              const std::string& model_version,
                                              const FindRevision& find);

}  // namespace tribodyn::server
