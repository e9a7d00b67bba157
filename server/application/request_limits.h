#pragma once

#include <google/protobuf/descriptor.h>

#include <cstddef>

namespace tribodyn::server {

/// Returns the largest serialised request of a method [bytes]: option max_request_bytes of the
/// contract, or kUsualRequestBytes. The limit of a gear set leaves 1 MiB of kMaximumResponseBytes
/// for the fields that the server adds to its answer.
std::size_t maximum_request_bytes(const google::protobuf::MethodDescriptor& method);

/// [bytes]. The longest lubricant takes 0.4 MB, the longest simulation 0.1 MB.
inline constexpr std::size_t kUsualRequestBytes = 1 << 20;
/// Of any method [bytes]. A batch of 20,000 lubricants with provenance takes 40 MB.
inline constexpr std::size_t kMaximumRequestBytes = 64 << 20;
inline constexpr std::size_t kMaximumResponseBytes = 16 << 20;

}  // namespace tribodyn::server
