#include "server/application/request_text.h"

#include <fmt/format.h>

#include <algorithm>

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
  if (one == other) return {};
  const auto differs = std::mismatch(one.begin(), one.end(), other.begin(), other.end()).first;
  const std::string equal(one.begin(), differs);
  const std::size_t begin = equal.rfind('\n') + 1;  // of the line; 0 in the first one
  const std::string& text = begin < one.size() ? one : other;
  return text.substr(begin, text.find('=', begin) - begin);
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
