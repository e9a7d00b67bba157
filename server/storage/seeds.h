#pragma once

#include <vector>

#include "server/storage/store.h"

namespace tribodyn::server {

/// The resources every database starts with (server/seeds/*.json, in the protos' JSON form,
/// embedded in the binary): names and serialised messages. Throws std::logic_error when a seed does
/// not parse, which a test rules out.
std::vector<NewResource> seed_resources();

}  // namespace tribodyn::server
