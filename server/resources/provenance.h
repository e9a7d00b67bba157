#pragma once

#include <google/protobuf/message.h>

#include <string>
#include <vector>

#include "server/contract/violations.h"
#include "tribodyn/v1/provenance.pb.h"

namespace tribodyn::server {

using Provenances = google::protobuf::RepeatedPtrField<v1::ParameterProvenance>;

/// The entry of the field itself, of the block it lies in ("dynamics" for "dynamics.x"), or "*";
/// null when there is none.
const v1::ParameterProvenance* find_provenance(const Provenances& all, const std::string& field);

/// Paths of the numbers inside a resource that the model uses, nested singular messages too
/// ("dynamics.half_backlash_metres"), and its blocks ("dynamics", "series", "flank_slots").
struct ParameterPaths {
  std::vector<std::string> numbers;
  std::vector<std::string> blocks;
};
ParameterPaths parameter_paths(const google::protobuf::Descriptor& resource);

/// Every entry names a number, a block or "*", once; a stated unit is the field's own; only a
/// number has an uncertainty. A misspelt field names the nearest.
void check_provenance(const google::protobuf::Descriptor& resource, const Provenances& all,
                      const std::string& path, Violations& violations);

/// Units are left out of what is stored and written into what is answered.
void clear_units(Provenances& all);
void fill_units(const google::protobuf::Descriptor& resource, Provenances& all);

/// An entry PROVENANCE_USER for every number, and every block that is there, that has none. Those
/// of a resource without blocks are sorted in the order of its fields: the same resource has the
/// same entries, whichever way it came in.
void complete_provenance(const google::protobuf::Message& resource, Provenances& all);

}  // namespace tribodyn::server
