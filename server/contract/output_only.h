#pragma once

#include <google/protobuf/message.h>

#include "proto/field_behavior.h"

namespace tribodyn::server {

/// Clears, at every depth, what only the server sets and fields of newer clients. What is left is
/// what an export keeps and an import takes.
void keep_client_part(google::protobuf::Message& message);

}  // namespace tribodyn::server
