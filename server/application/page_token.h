#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// Contents of a page token.
struct PageToken {
  PageStart last;          ///< last row of the previous page
  std::int64_t total = 0;  ///< length of the whole list when its first page was read
};

/// Returns an opaque token, which nobody makes or changes without the key. `scope` is the part of
/// the request that must not change between pages.
std::string page_token(const std::string& key, const std::string& scope, const PageToken& token);

/// Returns nullopt if page_token() did not make the token with this key for this scope.
std::optional<PageToken> parse_page_token(const std::string& key, const std::string& scope,
                                          const std::string& token);

}  // namespace tribodyn::server
