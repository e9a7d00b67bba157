#pragma once

#include "server/contract/resource_names.h"
#include "server/storage/store.h"

namespace tribodyn::server {

/// Finds resources in the store, which must outlive the lookup, for a caller who waits for so long.
ResourceLookup resource_lookup(Store& store, const CallLimits& limits = {});

/// As resource_lookup(), but finds the four resources of `simulation` in the revisions that the
/// simulation was accepted with, even if a resource has been deleted since.
ResourceLookup accepted_lookup(Store& store, const StoredSimulation& simulation);

}  // namespace tribodyn::server
