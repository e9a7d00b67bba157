#pragma once

#include <cstddef>
#include <string>

namespace tribodyn::server {

/// Returns random bytes of the operating system, fit for secrets; at most 256. Throws
/// std::runtime_error if it has none.
std::string random_bytes(std::size_t count);

}  // namespace tribodyn::server
