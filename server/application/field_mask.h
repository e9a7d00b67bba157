#pragma once

#include <google/protobuf/field_mask.pb.h>
#include <google/protobuf/message.h>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// Copies into `target` the fields of `source` that the mask names, at the top or in a message
/// there
/// ("measurements.densities"). An omitted mask names the fields that `source` populates (AIP-134),
/// so that nothing is lost which a client left out; "*" names all fields, set or not. A number that
/// changes while the mask leaves out the provenance loses its entry there. Unknown fields are
/// violations at "update_mask", with the nearest known name. A mask of more than kMaximumMaskPaths
/// paths is refused whole.
void merge(const google::protobuf::Message& source, const google::protobuf::FieldMask& mask,
           google::protobuf::Message& target, Violations& violations);

}  // namespace tribodyn::server
