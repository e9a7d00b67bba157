#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// What a page token says.
struct PageToken {
  PageStart last;          ///< where the page begins: after this one
  std::int64_t total = 0;  ///< rows of the whole list when its first page was read
};

/// An opaque token; `scope` is everything of the request that must stay the same from page to page.
std::string page_token(const std::string& scope, const PageToken& token);

/// Returns nullopt if the token was not given out for this scope.
std::optional<PageToken> parse_page_token(const std::string& scope, const std::string& token);

}  // namespace tribodyn::server
