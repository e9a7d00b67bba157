#pragma once

#include <google/protobuf/message.h>

#include <memory>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// Returns the collection of a full name, e.g. "lubricants" of "projects/acme/lubricants/my-oil".
std::string collection_of(std::string_view full_name);
/// Returns the collection with its project, e.g. "projects/acme/lubricants": what the database
/// calls the collection.
std::string full_collection_of(std::string_view full_name);

/// Returns an empty message of the kind of a collection; null for an unknown collection.
std::unique_ptr<google::protobuf::Message> new_resource(std::string_view collection);

}  // namespace tribodyn::server
