#pragma once

#include <cstdint>

#include "server/storage/connection.h"
#include "server/storage/times.h"

namespace tribodyn::server {

/// Number and bytes of what was removed.
struct Removed {
  int simulations = 0;
  int campaigns = 0;
  std::int64_t bytes = 0;
  int count() const { return simulations + campaigns; }
};

/// Removes the oldest simulations, at most `limit`, that ended by `ended_by` and are not pinned,
/// with their events and with results and ledgers that no other simulation uses; and the oldest
/// campaign that ended by then and no later than those. Works inside the caller's transaction.
/// Throws SQLite::Exception.
Removed remove_oldest(Connection& db, Microseconds ended_by, int limit);

/// Returns the used bytes of the database, without free pages. Throws SQLite::Exception.
std::int64_t used_bytes(Connection& db);

/// Returns the bytes that remove_oldest() can free: those of ended simulations that are not pinned,
/// of results that no pinned simulation uses, and of ended campaigns. Throws SQLite::Exception.
std::int64_t removable_bytes(Connection& db);

}  // namespace tribodyn::server
