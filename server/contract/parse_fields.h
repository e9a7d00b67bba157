#pragma once

#include <google/protobuf/message.h>

#include <initializer_list>
#include <string_view>

namespace tribodyn::server {

/// Parses the fields of a serialised message that have one of the numbers, and skips the others.
/// Returns false if the bytes are not such a message.
bool parse_fields(std::string_view bytes, std::initializer_list<int> numbers,
                  google::protobuf::Message& out);

}  // namespace tribodyn::server
