#pragma once

#include <google/protobuf/descriptor.h>

namespace tribodyn {

/// Returns whether only the server sets a field (OUTPUT_ONLY). The server ignores it in a request,
/// and no export needs it.
bool is_output_only(const google::protobuf::FieldDescriptor& field);

}  // namespace tribodyn
