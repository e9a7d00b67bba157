#pragma once

#include <string>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/storage/store.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Returns a lookup of resources of a project by their relative names, within the limits of the
/// call. The store must outlive the lookup.
ResourceLookup resource_lookup(Store& store, const std::string& project,
                               const CallLimits& limits = {});

/// Like resource_lookup(), but finds the four resources of a simulation or campaign in the
/// revisions with which it was accepted, even if a resource has been deleted since.
ResourceLookup accepted_lookup(Store& store, const std::string& project,
                               const ResourceRevisions& revisions);

/// Fills each empty resource name of `request` with the name of the revision that the simulation
/// was accepted with: an older version may have accepted it with another default.
void set_accepted_names(const ResourceRevisions& revisions, v1::Simulation& request);

}  // namespace tribodyn::server
