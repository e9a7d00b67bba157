#pragma once

#include <google/protobuf/repeated_ptr_field.h>

#include <string>

#include "server/contract/violations.h"
#include "tribodyn/v1/labels.pb.h"

namespace tribodyn::server {

using Labels = google::protobuf::RepeatedPtrField<v1::Label>;

inline constexpr int kMaximumLabels = 64;

/// Adds a violation for each key that is not made of letters, digits, '-', '_' and '.', and for
/// each key that occurs twice.
void check_labels(const Labels& labels, const std::string& path, Violations& violations);

/// Sorts labels by key.
void sort_labels(Labels& labels);

}  // namespace tribodyn::server
