#pragma once

#include <string>
#include <vector>

namespace tribodyn::client {

/// Returns the filter of a list with a restriction for each label: "project=axle" becomes
/// `labels.project = "axle"`, "project" becomes `labels.project:*`.
std::string with_labels(std::string filter, const std::vector<std::string>& labels);

}  // namespace tribodyn::client
