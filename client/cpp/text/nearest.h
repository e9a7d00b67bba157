#pragma once

#include <string>
#include <vector>

namespace tribodyn::client {

/// Returns the known name that is nearest to a mistyped one, or that begins with its words; empty
/// if none is near enough. The server has its own (contract/resource_names.h), which also accepts
/// prefixes: the client links nothing of the server.
std::string nearest(const std::string& word, const std::vector<std::string>& known);

}  // namespace tribodyn::client
