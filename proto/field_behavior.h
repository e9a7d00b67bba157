#pragma once

#include <google/protobuf/descriptor.h>

namespace tribodyn {

/// Returns whether only the server sets a field (OUTPUT_ONLY). The server ignores it in a request,
/// and no export needs it.
bool is_output_only(const google::protobuf::FieldDescriptor& field);

/// Returns whether a number of a resource may be unset (OPTIONAL).
bool may_be_unset(const google::protobuf::FieldDescriptor& field);

/// Returns whether the model does not use a number of a resource. It is no parameter: it has no
/// provenance.
bool is_documentary(const google::protobuf::FieldDescriptor& field);

}  // namespace tribodyn
