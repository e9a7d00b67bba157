#pragma once

#include <string>
#include <vector>

namespace tribodyn::client {

/// Returns the known name that is nearest to a mistyped one; empty if none is near enough.
std::string nearest(const std::string& word, const std::vector<std::string>& known);

}  // namespace tribodyn::client
