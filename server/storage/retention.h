#pragma once

#include <cstdint>

#include "server/storage/connection.h"
#include "server/storage/times.h"

namespace tribodyn::server {

/// Number and bytes of removed simulations.
struct Removed {
  int simulations = 0;
  std::int64_t bytes = 0;
};

/// Removes the oldest simulations, at most `limit`, that ended by `ended_by` and are not pinned,
/// with their events and with results and ledgers that no other simulation uses. Works inside the
/// caller's transaction. Throws SQLite::Exception.
Removed remove_oldest(Connection& db, Microseconds ended_by, int limit);

/// Returns the used bytes of the database, without free pages. Throws SQLite::Exception.
std::int64_t used_bytes(Connection& db);

/// Returns the bytes that remove_oldest() can free: those of ended simulations that are not pinned,
/// and of results that no pinned simulation uses. Throws SQLite::Exception.
std::int64_t removable_bytes(Connection& db);

}  // namespace tribodyn::server
