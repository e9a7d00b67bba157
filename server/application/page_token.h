#pragma once

#include <optional>
#include <string>

#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// An opaque token for the page that begins after `last`; `scope` is everything of the request that
/// must stay the same from page to page.
std::string page_token(const std::string& scope, const PageStart& last);

/// Where the page begins; nothing when the token was not given out for this scope.
std::optional<PageStart> parse_page_token(const std::string& scope, const std::string& token);

}  // namespace tribodyn::server
