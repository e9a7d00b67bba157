#pragma once

#include <google/protobuf/field_mask.pb.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "server/application/element_limits.h"
#include "server/contract/check_message.h"
#include "server/contract/labels.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {

/// Returns the labels of a message as they are stored.
template <class Resource>
std::vector<std::pair<std::string, std::string>> labels_of(const Resource& message) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const v1::Label& each : message.labels()) out.emplace_back(each.key(), each.value());
  return out;
}

/// Copies the display name and the labels that an update changes from `stated` into `target`, and
/// checks them. `path`: of `stated` in the request. An empty mask means the fields that are set.
/// `others`: paths that the mask may have too.
template <class Resource>
void take_over_labels(const google::protobuf::FieldMask& mask, const Resource& stated,
                      const std::string& path, Resource& target, Violations& violations,
                      const std::vector<std::string>& others = {}) {
  const auto& paths = mask.paths();
  const bool is_all = paths.size() == 1 && paths.Get(0) == "*";
  bool takes_name = is_all || (paths.empty() && !stated.display_name().empty());
  bool takes_labels = is_all || (paths.empty() && stated.labels_size() > 0);
  for (int i = 0; i < paths.size() && !is_all; ++i) {
    if (paths.Get(i) == "display_name") {
      takes_name = true;
    } else if (paths.Get(i) == "labels") {
      takes_labels = true;
    } else if (std::find(others.begin(), others.end(), paths.Get(i)) == others.end()) {
      std::string allowed = "display_name, labels";
      for (const std::string& each : others) allowed += ", " + each;
      violations.add("update_mask", "\"{}\" cannot be changed; allowed: {}, *",
                     plain_excerpt(paths.Get(i)), allowed);
      return;
    }
  }
  if (takes_name) target.set_display_name(stated.display_name());
  if (takes_labels) *target.mutable_labels() = stated.labels();
  sort_labels(*target.mutable_labels());
  // Only these two change; the other fields were checked when they were accepted.
  Resource changed;
  changed.set_display_name(target.display_name());
  *changed.mutable_labels() = target.labels();
  Violations all;
  check_message(changed, path, all);
  for (Violation& each : all) {
    const bool is_of_label = each.field.starts_with(path + ".labels");
    if (is_of_label || each.field == path + ".display_name") violations.push_back(std::move(each));
  }
  if (target.labels_size() > kMaximumLabels) {
    violations.add(path + ".labels", too_many_text(target.labels_size(), kMaximumLabels));
  } else {
    check_labels(target.labels(), path + ".labels", violations);
  }
}

}  // namespace tribodyn::server
