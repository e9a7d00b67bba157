#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <functional>
#include <string>

namespace tribodyn::server {

using IsLeftOut = std::function<bool(const google::protobuf::FieldDescriptor&)>;

/// Appends the values of a message to `text`, one line "path=value" for each in field order.
/// Numbers are hexadecimal doubles, enum values are names. Messages with equal values get equal
/// text, whatever their serialised bytes. Throws std::logic_error for a field of an unsupported
/// type.
void add_canonical_text(const google::protobuf::Message& message, const std::string& path,
                        const IsLeftOut& is_left_out, std::string& text);

}  // namespace tribodyn::server
