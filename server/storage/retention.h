#pragma once

#include <cstdint>

#include "server/storage/connection.h"
#include "server/storage/times.h"

namespace tribodyn::server {

/// What remove_oldest has removed.
struct Removed {
  int simulations = 0;
  std::int64_t bytes = 0;
};

/// Removes the oldest simulations, at most `limit`, that had ended by `ended_by` and are not
/// pinned, with their events, and results and ledgers that no other one has. Inside the caller's
/// transaction. Throws SQLite::Exception.
Removed remove_oldest(Connection& db, Microseconds ended_by, int limit);

/// Bytes of the database in use; free pages do not count. Throws SQLite::Exception.
std::int64_t used_bytes(Connection& db);

/// Bytes that remove_oldest can free: of simulations that have ended and are not pinned, and of
/// results that no pinned one has. Throws SQLite::Exception.
std::int64_t removable_bytes(Connection& db);

}  // namespace tribodyn::server
