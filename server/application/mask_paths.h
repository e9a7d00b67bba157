#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/field_mask.pb.h>

#include <string>
#include <vector>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// Returns true if the mask is "*", which names every field.
bool names_all(const google::protobuf::FieldMask& mask);

/// Returns true if the mask has at most kMaximumMaskPaths paths; adds a violation at `mask_field`
/// if it has more.
bool check_path_count(const google::protobuf::FieldMask& mask, const std::string& mask_field,
                      Violations& violations);

/// Returns the fields along a path of a mask ("measurements.densities"), from the top of `message`
/// to the named field. Returns none, and adds a violation at `mask_field` with the nearest known
/// name, if the path leads to no field.
std::vector<const google::protobuf::FieldDescriptor*> fields_along(
    const std::string& path, const google::protobuf::Descriptor& message,
    const std::string& mask_field, Violations& violations);

}  // namespace tribodyn::server
