#pragma once

#include <google/protobuf/descriptor.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/application/method_table.h"

namespace tribodyn::server {

/// A method and what the path of a request says of its fields.
struct RouteMatch {
  const Method* method = nullptr;
  std::string body_field;  ///< "*", the name of a field, or "" for no body
  std::map<std::string, std::string>
      of_path;  ///< values by path of the field, e.g. "lubricant.name"
};

/// The routes of all methods, as google.api.http of the contract states them.
class HttpRoutes {
 public:
  /// Throws std::logic_error if a method has no route, a template cannot be read or names a field
  /// that the request does not have, or two methods have the same route. `methods` must outlive
  /// the object.
  explicit HttpRoutes(const std::vector<Method>& methods);

  /// Returns the method of a verb and a percent-encoded path without query, or nullopt.
  std::optional<RouteMatch> find(std::string_view verb, std::string_view path) const;
  /// Returns the verbs that a path has methods for, in alphabetical order.
  std::vector<std::string> verbs(std::string_view path) const;

  /// A route: the template of its path in segments, and which of them give a field its value.
  struct Route {
    struct Variable {
      std::string field;  ///< its path, e.g. "lubricant.name"
      std::size_t first = 0;
      std::size_t count = 0;
    };
    const Method* method = nullptr;
    std::string verb;
    std::string text;                   ///< the template as the contract states it
    std::vector<std::string> segments;  ///< "*" stands for any
    std::string custom_verb;            ///< e.g. "cancel", or ""
    std::vector<Variable> variables;
    std::string body_field;
  };
  const std::vector<Route>& all() const { return routes_; }

 private:
  std::vector<Route> routes_;
};

/// Decodes "%2F" and the like. Returns nullopt if a percent sign is not followed by two hexadecimal
/// digits, or if the text holds a NUL.
std::optional<std::string> percent_decoded(std::string_view text);

}  // namespace tribodyn::server
