#pragma once

#include <google/protobuf/descriptor.h>

#include <cstddef>

namespace tribodyn::server {

/// Largest serialised request of a method [bytes]: that of its row in the table, or
/// kUsualRequestBytes.
std::size_t maximum_request_bytes(const google::protobuf::MethodDescriptor& method);

/// A lubricant with every text at its longest takes 0.4 MB, a simulation 0.1 MB.
inline constexpr std::size_t kUsualRequestBytes = 1 << 20;
/// The longest request of all, a batch: 20,000 lubricants with provenance take 40 MB.
inline constexpr std::size_t kMaximumRequestBytes = 64 << 20;
inline constexpr std::size_t kMaximumResponseBytes = 16 << 20;

}  // namespace tribodyn::server
