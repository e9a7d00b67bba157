#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "server/contract/violations.h"

namespace tribodyn::server {

inline constexpr int kMaximumPageSize = 1000;
inline constexpr std::size_t kMaximumPageBytes =
    2'000'000;  // [bytes]; gRPC clients accept 4 MB by default

/// Returns the page size of a request (AIP-158): `fallback` for 0, at most kMaximumPageSize. Adds a
/// violation if it is negative.
inline int page_size(int requested, int fallback, Violations& violations) {
  if (requested < 0) {
    violations.add("page_size", "page_size = {}; allowed: 0 (means {}) to {}", requested, fallback,
                   kMaximumPageSize);
  }
  return requested == 0 ? fallback : std::min(requested, kMaximumPageSize);
}

/// Returns a number of rows as the total_size of a list. Limits it to 32 bits, as a forged token
/// may hold any number.
inline std::int32_t clamped_total(std::int64_t rows) {
  return static_cast<std::int32_t>(
      std::min<std::int64_t>(rows, std::numeric_limits<std::int32_t>::max()));
}

inline void add_bad_page_token(Violations& violations) {
  violations.add("page_token", "not a token that this server gave out");
}

}  // namespace tribodyn::server
