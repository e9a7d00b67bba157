#include "client/cpp/commands/label_filter.h"

namespace tribodyn::client {
namespace {

/// Returns `labels.project = "axle"` for "project=axle", `labels.project:*` for "project".
std::string label_restriction(const std::string& label) {
  const std::size_t mark = label.find('=');
  if (mark == std::string::npos) return "labels." + label + ":*";
  std::string value;
  for (const char c : label.substr(mark + 1)) {
    if (c == '"' || c == '\\') value += '\\';
    value += c;
  }
  return "labels." + label.substr(0, mark) + " = \"" + value + "\"";
}

}  // namespace

std::string with_labels(std::string filter, const std::vector<std::string>& labels) {
  for (const std::string& label : labels) {
    filter += (filter.empty() ? "" : " AND ") + label_restriction(label);
  }
  return filter;
}

}  // namespace tribodyn::client
