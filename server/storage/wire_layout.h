#pragma once

#include <google/protobuf/descriptor.h>

#include <string>
#include <vector>

namespace tribodyn::server {

/// The messages that a database holds in binary form.
std::vector<const google::protobuf::Descriptor*> stored_messages();

/// Returns how messages, and those in them, are written: a line for each field and each value of an
/// enum, with its number, name and type. It is the same text in every build; comments and options
/// do not count.
std::string wire_layout(const std::vector<const google::protobuf::Descriptor*>& messages);

}  // namespace tribodyn::server
