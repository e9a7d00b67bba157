#pragma once

#include <google/protobuf/message.h>

#include <string>
#include <vector>

#include "server/contract/violations.h"
#include "tribodyn/v1/provenance.pb.h"

namespace tribodyn::server {

using Provenances = google::protobuf::RepeatedPtrField<v1::ParameterProvenance>;

/// Returns the entry of the field, of its block ("dynamics" for "dynamics.x"), or of "*", in this
/// order; null if there is none.
const v1::ParameterProvenance* find_provenance(const Provenances& all, const std::string& field);

/// Paths of the numbers of a resource that the model uses, including those in nested singular
/// messages ("dynamics.half_backlash_metres"), and of its blocks ("dynamics", "series",
/// "flank_slots").
struct ParameterPaths {
  std::vector<std::string> numbers;
  std::vector<std::string> blocks;
};
ParameterPaths parameter_paths(const google::protobuf::Descriptor& resource);

/// Checks that every entry names a number, a block or "*", that none is named twice, that a unit is
/// the unit of the field, and that only a number has an uncertainty. The violation of an unknown
/// field suggests the nearest name.
void check_provenance(const google::protobuf::Descriptor& resource, const Provenances& all,
                      const std::string& path, Violations& violations);

/// Stored entries have no units; answers have them.
void clear_units(Provenances& all);
void fill_units(const google::protobuf::Descriptor& resource, Provenances& all);

/// Adds an entry PROVENANCE_USER for every number and every set block that has none. Sorts the
/// entries of a resource without tables, numbers by the order of their fields and then blocks, so
/// that equal resources have equal entries.
void complete_provenance(const google::protobuf::Message& resource, Provenances& all);

}  // namespace tribodyn::server
