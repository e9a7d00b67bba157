#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <cstdint>
#include <optional>
#include <string>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// Returns the largest number of elements of a list in any acceptable request: option max_items of
/// the contract, or kMaximumMaskPaths for a field mask. Returns nullopt if the field has neither;
/// every repeated field of a request has one.
std::optional<int> maximum_elements(const google::protobuf::FieldDescriptor& field);

/// Returns "65 entries; allowed: at most 64".
std::string too_many_text(std::int64_t count, std::int64_t maximum);

/// Adds a violation for every list in `message`, at any depth, that has more elements than
/// maximum_elements() allows. Does not check the elements of such a list.
void check_counts(const google::protobuf::Message& message, const std::string& path,
                  Violations& violations);

inline constexpr int kMaximumMaskPaths = 200;  ///< more than any resource has fields
/// Messages, texts in lists and unknown fields in one request. A batch of 20,000 lubricants with 17
/// provenance entries, 5 labels and 8 measurements each has 0.7 million.
inline constexpr int kMaximumRequestElements = 1'000'000;
/// Unknown fields in one message, e.g. of a newer client.
inline constexpr int kMaximumUnknownFields = 100;

}  // namespace tribodyn::server
