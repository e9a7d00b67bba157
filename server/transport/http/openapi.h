#pragma once

#include <string>

#include "server/transport/http/http_routes.h"

namespace tribodyn::server {

/// Returns the description of the REST interface as OpenAPI 3.1, in JSON: every route, the schemas
/// of protobuf's JSON as this server writes and reads it, errors, conditions, and the protos'
/// comments as documentation. It is the same for every server of a version and holds nothing of
/// what a server keeps.
std::string openapi_document(const HttpRoutes& routes);

/// Returns the same description as a page for people, in HTML without scripts, whose style is at
/// kOpenApiStylePath. `document` is one of openapi_document().
std::string openapi_page(const std::string& document);
/// Returns the style of the page, in CSS.
std::string openapi_style();

inline constexpr char kOpenApiPath[] = "/openapi.json";
inline constexpr char kOpenApiPagePath[] = "/docs";
inline constexpr char kOpenApiStylePath[] = "/docs.css";

}  // namespace tribodyn::server
