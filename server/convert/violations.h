#pragma once

#include <string>
#include <vector>

namespace tribodyn::server {

/// One thing wrong with a request: the path of the field, and a sentence that names value, unit,
/// legal range and the equation that needs it. Becomes a google.rpc.BadRequest.FieldViolation.
struct Violation {
  std::string field;
  std::string description;
};

using Violations = std::vector<Violation>;

/// "prefix.field", or "field" when the prefix is empty.
inline std::string join_path(const std::string& prefix, const std::string& field) {
  return prefix.empty() ? field : prefix + "." + field;
}

}  // namespace tribodyn::server
