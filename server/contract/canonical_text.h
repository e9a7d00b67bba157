#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <functional>
#include <string>

namespace tribodyn::server {

using IsLeftOut = std::function<bool(const google::protobuf::FieldDescriptor&)>;

/// Adds the values of a message as text, one "path=value" line each in field order: numbers as
/// hexadecimal doubles, enums by name. Equal values make equal text, whatever the bytes of the
/// message. Throws std::logic_error for a type of field that has no form yet.
void add_canonical_text(const google::protobuf::Message& message, const std::string& path,
                        const IsLeftOut& is_left_out, std::string& text);

}  // namespace tribodyn::server
