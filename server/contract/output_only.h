#pragma once

#include <google/protobuf/message.h>

#include "proto/field_behavior.h"

namespace tribodyn::server {

/// Clears output-only fields and unknown fields (those of newer clients) at every depth. The
/// remaining fields are those that an export writes and an import reads.
void keep_client_part(google::protobuf::Message& message);

}  // namespace tribodyn::server
