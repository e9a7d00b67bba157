#pragma once

#include <google/protobuf/descriptor.pb.h>

#include <string>
#include <vector>

namespace tribodyn {

/// Returns what breaks the contract's own rules, one sentence each:
/// - fields are snake_case, values UPPER_SNAKE_CASE; values of an enum of the package carry its
///   name, values of a nested enum either all do or none; number 0 is ..._UNSPECIFIED;
/// - services end in Service; a request is named after its method, and so is a response;
/// - every method has one HTTP route of its own;
/// - every message, field, enum, value, service and method has a comment (number 0 of an enum may
///   go without);
/// - a real number ends in its unit, or in a word for a pure number, each with one spelling.
/// `set` needs source information.
std::vector<std::string> lint(const google::protobuf::FileDescriptorSet& set);

}  // namespace tribodyn
