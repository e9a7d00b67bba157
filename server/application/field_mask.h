#pragma once

#include <google/protobuf/field_mask.pb.h>
#include <google/protobuf/message.h>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// Takes over into `target` the fields of `source` that the mask names, at the top or in a message
/// there ("measurements.densities"); all of them when it is empty or "*". A number that is changed
/// while its provenance is not taken over loses that provenance. Unknown fields are violations at
/// "update_mask" and name the nearest. A mask of more than kMaximumMaskPaths paths is refused
/// whole.
void merge(const google::protobuf::Message& source, const google::protobuf::FieldMask& mask,
           google::protobuf::Message& target, Violations& violations);

}  // namespace tribodyn::server
