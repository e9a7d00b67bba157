#include "server/contract/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "server/contract/resource_names.h"

namespace tribodyn::server {
namespace {

bool is_key(const std::string& key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  });
}

}  // namespace

void check_labels(const Labels& labels, const std::string& path, Violations& violations) {
  std::set<std::string> keys;
  for (int i = 0; i < labels.size(); ++i) {
    const std::string& key = labels.Get(i).key();
    const std::string here = fmt::format("{}[{}].key", path, i);
    if (!is_key(key)) {
      violations.add(here, "\"{}\"; allowed: letters, digits, '-', '_' and '.'",
                     plain_excerpt(key));
    } else if (!keys.insert(key).second) {
      violations.add(here, "\"{}\" is named twice", key);
    }
  }
}

void sort_labels(Labels& labels) {
  std::sort(labels.begin(), labels.end(),
            [](const v1::Label& a, const v1::Label& b) { return a.key() < b.key(); });
}

}  // namespace tribodyn::server
