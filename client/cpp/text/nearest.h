#pragma once

#include <string>
#include <vector>

namespace tribodyn::client {

/// The known name nearest to a mistyped one, if it is near enough to be meant.
std::string nearest(const std::string& word, const std::vector<std::string>& known);

}  // namespace tribodyn::client
