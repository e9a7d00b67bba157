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

/// A stored revision as it is answered: with what only the server knows, and with the units of its
/// parameters. An older revision bears its revision in its name. Nothing when it does not parse.
template <class Resource>
std::optional<Resource> to_message(const StoredResource& stored) {
  using google::protobuf::util::TimeUtil;
  Resource out;
  if (!out.ParseFromString(stored.body)) return std::nullopt;
  // Bodies of earlier versions may lack entries; an export of them is the same once imported.
  complete_provenance(out, *out.mutable_provenance());
  fill_units(*Resource::descriptor(), *out.mutable_provenance());
  out.set_name(stored.is_present ? stored.name : revision_name(stored.name, stored.revision));
  out.set_etag(etag_of(stored));
  out.set_revision(stored.revision);
  *out.mutable_create_time() = TimeUtil::MicrosecondsToTimestamp(stored.create_time);
  *out.mutable_revision_create_time() =
      TimeUtil::MicrosecondsToTimestamp(stored.revision_create_time);
  if (stored.delete_time) {
    *out.mutable_delete_time() = TimeUtil::MicrosecondsToTimestamp(*stored.delete_time);
  }
  return out;
}

}  // namespace tribodyn::server
