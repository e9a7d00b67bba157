#include "server/application/request_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "server/contract/canonical_text.h"
#include "server/contract/output_only.h"

namespace tribodyn::server {

std::string request_text(const v1::Simulation& requested, bool force) {
  std::string text = fmt::format("force={}\n", force);
  add_canonical_text(
      requested, "simulation",
      [](const google::protobuf::FieldDescriptor& field) { return is_output_only(field); }, text);
  return text;
}

std::string first_difference(const std::string& one, const std::string& other) {
  std::istringstream lines(one);
  std::istringstream other_lines(other);
  std::string line;
  std::string other_line;
  for (;;) {
    const bool more = static_cast<bool>(std::getline(lines, line));
    const bool other_more = static_cast<bool>(std::getline(other_lines, other_line));
    if (!more && !other_more) return {};
    if (!more) return other_line.substr(0, other_line.find('='));
    if (!other_more || line != other_line) return line.substr(0, line.find('='));
  }
}

void check_request_id(const std::string& request_id, Violations& violations) {
  const bool is_printable =
      std::all_of(request_id.begin(), request_id.end(), [](char c) { return c > ' ' && c <= '~'; });
  if (is_printable && request_id.size() <= kMaximumRequestIdLength) return;
  violations.push_back(
      {"request_id", fmt::format("request_id has {} bytes; allowed: at most {}, printable ASCII "
                                 "without spaces",
                                 request_id.size(), kMaximumRequestIdLength)});
}

}  // namespace tribodyn::server
