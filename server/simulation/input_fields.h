#pragma once

#include <google/protobuf/descriptor.h>

namespace tribodyn::server {

/// Role of a field of a resource or simulation for a result.
enum class InputRole {
  kInput,         ///< the model may use it: part of the input hash
  kLabel,         ///< name, origin or schedule: not part of the input hash
  kOutput,        ///< only the server sets it (option output_only)
  kUnclassified,  ///< missing in the table; hashed as an input, which is safe
};

/// Returns the role of a field from the table in input_fields.cpp, which has a row for every
/// message that input hashes cover.
InputRole input_role(const google::protobuf::FieldDescriptor& field);

}  // namespace tribodyn::server
