#pragma once

#include <google/protobuf/descriptor.h>

#include <string>
#include <string_view>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// Returns the names of an enum's values, separated by commas.
std::string values_of(const google::protobuf::EnumDescriptor& type);

/// Returns the violation of a body that is no JSON of `type`, from what protobuf's parser says of
/// it: the field with its path under `prefix`, its value, and the values or names that are allowed
/// there. The violation of a text that is no JSON names `prefix` and what the parser expected.
Violation body_violation(const google::protobuf::Descriptor& type, const std::string& prefix,
                         std::string_view complaint);

}  // namespace tribodyn::server
