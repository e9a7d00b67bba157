#pragma once

#include <google/protobuf/descriptor.h>

namespace tribodyn {

/// Returns whether only the server sets a field (OUTPUT_ONLY). The server ignores it in a request,
/// and no export needs it.
bool is_output_only(const google::protobuf::FieldDescriptor& field);

/// Returns whether a number of a resource may be unset because the model does not use it
/// (OPTIONAL). It is no parameter: it has no provenance.
bool is_documentary(const google::protobuf::FieldDescriptor& field);

}  // namespace tribodyn
