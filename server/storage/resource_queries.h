#pragma once

#include "server/storage/connection.h"
#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// Returns a page of resources. It uses indexes for any number of resources: a page in the order of
/// the name or of a property starts where the previous page ended; if a restriction selects few
/// resources, its index comes first and its rows are sorted. Only "contains" and "not equal" read
/// resources one by one. Throws SQLite::Exception.
Page<StoredResource> query_resources(Connection& db, const ResourceQuery& query);

}  // namespace tribodyn::server
