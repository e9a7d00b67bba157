#pragma once

#include <google/protobuf/descriptor.pb.h>

#include <string>
#include <vector>

namespace tribodyn {

/// Returns what `now` breaks of `before`, one sentence each: a message, field, value, oneof,
/// service or method that vanished, or a number, name, type, cardinality or oneof that changed. A
/// field or value may vanish if its number and its name are reserved. Additions break nothing.
std::vector<std::string> breaking_changes(const google::protobuf::FileDescriptorSet& before,
                                          const google::protobuf::FileDescriptorSet& now);

}  // namespace tribodyn
