#pragma once

#include <vector>

#include "server/storage/store.h"

namespace tribodyn::server {

/// Returns the resources of a new database (server/seeds/*.json in the JSON form of the protos,
/// embedded in the program): names and serialised messages. Throws std::logic_error if a seed
/// cannot be parsed; a test excludes that.
std::vector<NewResource> seed_resources();

}  // namespace tribodyn::server
