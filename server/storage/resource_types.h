#pragma once

#include <google/protobuf/message.h>

#include <memory>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// "lubricants" of "lubricants/1".
std::string collection_of(std::string_view name);

/// An empty message of the kind that a collection holds; null for an unknown collection.
std::unique_ptr<google::protobuf::Message> new_resource(std::string_view collection);

/// Sets every number with presence that is unset, at every depth of singular messages that are
/// there, to zero.
void set_missing_numbers(google::protobuf::Message& message);

}  // namespace tribodyn::server
