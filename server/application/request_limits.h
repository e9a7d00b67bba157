#pragma once

#include <google/protobuf/descriptor.h>

#include <cstddef>

namespace tribodyn::server {

/// Returns the largest serialised request of a method [bytes]: option max_request_bytes of the
/// contract, or kUsualRequestBytes. A gear set leaves 1 MiB of kMaximumResponseBytes to what the
/// server adds in its answer.
std::size_t maximum_request_bytes(const google::protobuf::MethodDescriptor& method);

/// A lubricant with every text at its longest takes 0.4 MB, a simulation 0.1 MB.
inline constexpr std::size_t kUsualRequestBytes = 1 << 20;
/// The longest request of all, a batch: 20,000 lubricants with provenance take 40 MB.
inline constexpr std::size_t kMaximumRequestBytes = 64 << 20;
inline constexpr std::size_t kMaximumResponseBytes = 16 << 20;

}  // namespace tribodyn::server
