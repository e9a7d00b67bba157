#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

namespace tribodyn::server {

/// True for a field that only the server sets (option output_only of the contract).
bool is_output_only(const google::protobuf::FieldDescriptor& field);

/// Clears, at every depth, what only the server sets and fields of newer clients. What is left is
/// what an export keeps and an import takes.
void keep_client_part(google::protobuf::Message& message);

}  // namespace tribodyn::server
