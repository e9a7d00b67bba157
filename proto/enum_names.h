#pragma once

#include <google/protobuf/descriptor.h>

#include <string>
#include <string_view>

namespace tribodyn {

/// Returns the name that people read and type, without the name of its enum: "FULL" of
/// POINT_MODEL_FULL. Values without that prefix, and those of number 0, keep their names.
std::string short_name(const google::protobuf::EnumValueDescriptor& value);

/// As above, of a number that a message holds: the digits if no value has that number.
std::string short_name(const google::protobuf::EnumDescriptor& type, int number);

/// Returns the value whose name or short name is `name`; nullptr if there is none.
const google::protobuf::EnumValueDescriptor* find_value(
    const google::protobuf::EnumDescriptor& type, std::string_view name);

/// Returns the prefix that the names of values carry: "POINT_MODEL_" of PointModel.
std::string value_prefix(const google::protobuf::EnumDescriptor& type);

}  // namespace tribodyn
