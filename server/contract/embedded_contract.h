#pragma once

#include <string_view>

namespace tribodyn::server {

/// Returns the descriptors of the contract with their comments: a google.protobuf.FileDescriptorSet
/// that protoc has written, in binary.
std::string_view embedded_contract();

}  // namespace tribodyn::server
