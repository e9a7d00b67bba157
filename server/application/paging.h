#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "server/contract/violations.h"

namespace tribodyn::server {

inline constexpr int kMaximumPageSize = 1000;
inline constexpr std::size_t kMaximumPageBytes = 2'000'000;  // clients accept 4 MB by default

/// The page size that a request means (AIP-158): 0 is the default, too many are cut.
inline int page_size(int requested, int otherwise, Violations& violations) {
  if (requested < 0) {
    violations.push_back({"page_size", fmt::format("page_size = {}; allowed: 0 (means {}) to {}",
                                                   requested, otherwise, kMaximumPageSize)});
  }
  return requested == 0 ? otherwise : std::min(requested, kMaximumPageSize);
}

/// A count of rows as the total_size of a list; what does not fit, as of a forged token, is cut.
inline std::int32_t clamped_total(std::int64_t rows) {
  return static_cast<std::int32_t>(
      std::min<std::int64_t>(rows, std::numeric_limits<std::int32_t>::max()));
}

inline void add_bad_page_token(Violations& violations) {
  violations.push_back({"page_token", "not a token that this server gave out"});
}

}  // namespace tribodyn::server
