#pragma once

#include <chrono>
#include <cstdint>

namespace tribodyn::server {

using Microseconds = std::int64_t;  ///< microseconds since 1970, UTC

/// Returns the time of the wall clock.
inline Microseconds system_time() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace tribodyn::server
