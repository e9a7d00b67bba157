#pragma once

#include <map>
#include <string>
#include <vector>

#include "server/transport/http/rest_handler.h"

namespace tribodyn::server {

/// Returns the pages that describe the REST interface of these methods: as OpenAPI and for people.
/// They need no token: they hold what the published contract holds, and nothing of this server.
std::map<std::string, RestHandler::Page> description_pages(const std::vector<Method>& methods);

}  // namespace tribodyn::server
