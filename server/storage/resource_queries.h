#pragma once

#include "server/storage/connection.h"
#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// The page of resources that a query means, by indices at any number of resources: ordered by name
/// or a property it goes on where the last page ended; a restriction that few resources meet leads,
/// and what it finds is sorted. Only "contains" and "not equal" have to look at resources one by
/// one. Throws SQLite::Exception.
Page<StoredResource> query_resources(Connection& db, const ResourceQuery& query);

}  // namespace tribodyn::server
