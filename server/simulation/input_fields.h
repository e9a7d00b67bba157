#pragma once

#include <google/protobuf/descriptor.h>

namespace tribodyn::server {

/// What a field of a resource or of a simulation is to a result.
enum class InputRole {
  kInput,         ///< the model may compute with it: part of the input hash
  kLabel,         ///< says what a thing is called, where it comes from or when it is wanted
  kOutput,        ///< only the server sets it (OUTPUT_ONLY)
  kUnclassified,  ///< missing in the table; hashed as an input, which is safe
};

/// The role of a field by the table in input_fields.cpp, which has a row for every message that
/// input hashes cover.
InputRole input_role(const google::protobuf::FieldDescriptor& field);

}  // namespace tribodyn::server
