#pragma once

#include <google/protobuf/descriptor.pb.h>

#include <string>
#include <vector>

namespace tribodyn {

/// Returns what breaks the contract's own rules, one sentence each:
/// - fields are snake_case, values UPPER_SNAKE_CASE; values of an enum of the package carry its
///   name, values of a nested enum either all do or none; number 0 is ..._UNSPECIFIED;
/// - a unit in the name of a field has one spelling;
/// - services end in Service; a request is named after its method, and so is a response;
/// - every method has one HTTP route of its own.
std::vector<std::string> lint(const google::protobuf::FileDescriptorSet& set);

}  // namespace tribodyn
