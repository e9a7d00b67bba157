#pragma once

#include <google/protobuf/util/time_util.h>

#include <optional>
#include <string>

#include "server/contract/resource_names.h"
#include "server/resources/provenance.h"
#include "server/storage/stored_resource.h"
#include "server/support/sha256.h"

namespace tribodyn::server {

/// AIP-154: another one for everything that clients may see of a resource.
inline std::string etag_of(const StoredResource& stored) {
  return sha256(revision_name(stored.name, stored.revision) + stored.content_hash +
                (stored.delete_time ? " deleted" : ""))
      .substr(0, 16);
}

/// A body as it is answered, with the units of its parameters and without what the store knows of
/// it. Returns nullopt if it does not parse.
template <class Resource>
std::optional<Resource> body_message(const std::string& body) {
  Resource out;
  if (!out.ParseFromString(body)) return std::nullopt;
  fill_units(*Resource::descriptor(), *out.mutable_provenance());
  return out;
}

inline google::protobuf::Timestamp timestamp_of(Microseconds time) {
  return google::protobuf::util::TimeUtil::MicrosecondsToTimestamp(time);
}

/// Sets what the store knows of a revision. An older revision bears its revision in its name.
template <class Resource>
void set_stored_fields(const StoredResource& stored, Resource& out) {
  out.set_name(stored.is_present ? stored.name : revision_name(stored.name, stored.revision));
  out.set_etag(etag_of(stored));
  out.set_revision(stored.revision);
  *out.mutable_create_time() = timestamp_of(stored.create_time);
  *out.mutable_revision_create_time() = timestamp_of(stored.revision_create_time);
  if (stored.delete_time) *out.mutable_delete_time() = timestamp_of(*stored.delete_time);
}

template <class Job>  // v1::Simulation or v1::Campaign
void set_revisions(const ResourceRevisions& revisions, Job& out) {
  out.set_lubricant_revision(revisions.lubricant);
  out.set_gear_set_revision(revisions.gear_set);
  out.set_surface_revision(revisions.surface);
  out.set_vehicle_revision(revisions.vehicle);
}

/// A stored revision as it is answered. Returns nullopt if its body does not parse.
template <class Resource>
std::optional<Resource> to_message(const StoredResource& stored) {
  auto out = body_message<Resource>(stored.body);
  if (out) set_stored_fields(stored, *out);
  return out;
}

}  // namespace tribodyn::server
