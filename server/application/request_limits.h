#pragma once

#include <google/protobuf/descriptor.h>

#include <cstddef>

namespace tribodyn::server {

/// Returns the largest serialised request of a method [bytes]: option max_request_bytes of the
/// contract, or kUsualRequestBytes. Those of a gear set and of a campaign leave 1 MiB of
/// kMaximumResponseBytes for the fields that the server adds to its answer.
std::size_t maximum_request_bytes(const google::protobuf::MethodDescriptor& method);

/// [bytes]. The longest lubricant takes 0.4 MB, the longest simulation 0.1 MB.
inline constexpr std::size_t kUsualRequestBytes = 1 << 20;
/// Of any method [bytes]. A batch of 20,000 lubricants with provenance takes 40 MB.
inline constexpr std::size_t kMaximumRequestBytes = 64 << 20;
/// Leaves 1 MiB beside the candidates of a campaign, which take up to 32 MiB.
inline constexpr std::size_t kMaximumResponseBytes = 33 << 20;

}  // namespace tribodyn::server
