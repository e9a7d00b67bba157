#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "server/transport/http/http_routes.h"

namespace tribodyn::server {

/// The OpenAPI description of the REST interface as a judge of JSON: a field that no schema names
/// is wrong, and so is a required one that is missing.
class OpenApiSchemas {
 public:
  explicit OpenApiSchemas(nlohmann::json document) : document_(std::move(document)) {}

  const nlohmann::json& document() const { return document_; }

  /// What a value need not have.
  enum class Rigour {
    kWhole,
    kSomeFields,  ///< required fields may be missing, as under a read_mask
  };
  /// Returns each place of a value that its schema does not allow, a line each; "" if it fits.
  std::string complaints(const nlohmann::json& value, const nlohmann::json& schema,
                         Rigour rigour = Rigour::kWhole) const;

  /// The operation of a route. Throws json::out_of_range if it is not described.
  const nlohmann::json& operation(const HttpRoutes::Route& route) const;

 private:
  void compare(const nlohmann::json& value, const nlohmann::json& schema, const std::string& place,
               Rigour rigour, std::string& wrong) const;

  nlohmann::json document_;
};

/// "/v1/projects/{}/lubricants/{}:undelete" of a route.
std::string route_shape(const HttpRoutes::Route& route);
/// The same of a path of the description: "/v1/lubricants/{lubricant}" without the names.
std::string path_shape(const std::string& path);

}  // namespace tribodyn::server
