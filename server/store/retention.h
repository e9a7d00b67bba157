#pragma once

#include <cstdint>

#include "server/store/connection.h"
#include "server/store/times.h"

namespace tribodyn::server {

/// Removes the oldest simulations, at most `limit`, that had ended by `ended_by` and are not
/// pinned, with their events, and results and ledgers that no other one has; how many. Inside the
/// caller's transaction. Throws SQLite::Exception.
int remove_oldest(Connection& db, Microseconds ended_by, int limit);

/// What the database holds, free pages left out.
std::int64_t used_bytes(Connection& db);

}  // namespace tribodyn::server
