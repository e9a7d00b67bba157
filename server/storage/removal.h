#pragma once

#include <cstdint>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// Removes a simulation with its labels, and its result and assumptions unless another simulation
/// uses them. One event remains, which tells of the deletion. Returns the freed bytes of the
/// result. Works inside the caller's transaction. Throws SQLite::Exception.
std::int64_t remove_simulation(Connection& db, std::int64_t id);

/// Simulations and campaigns that used any revision of a resource.
struct Dependents {
  std::vector<std::int64_t> unfinished;            ///< simulations that are QUEUED or RUNNING
  int ended = 0;                                   ///< simulations that are neither
  int results = 0;                                 ///< results that no other simulation has
  std::vector<std::int64_t> unfinished_campaigns;  ///< RUNNING or PAUSED
  int ended_campaigns = 0;

  int simulations() const { return static_cast<int>(unfinished.size()) + ended; }
  int campaigns() const { return static_cast<int>(unfinished_campaigns.size()) + ended_campaigns; }
  bool exist() const { return simulations() + campaigns() > 0; }
  bool are_ended() const { return unfinished.empty() && unfinished_campaigns.empty(); }
};

/// Returns what used a revision of the resource. Throws SQLite::Exception.
Dependents dependents_of(Connection& db, const StoredResource& resource);

/// Removes a resource with all its revisions, and every simulation, pinned or not, and every
/// campaign that used one of them. Requires that all of these have ended. Returns the number of
/// revisions. Works inside the caller's transaction. Throws SQLite::Exception.
int remove_resource(Connection& db, const StoredResource& resource);

/// Rewrites the database, so that neither its file nor its write-ahead log contains bytes of
/// removed rows. Time and disk space are proportional to the size of the database: about 1.4 s for
/// each 100 MB (measured), and twice its size for a temporary copy and for the log. Requires that
/// the connection has no open transaction. Throws SQLite::Exception, e.g. if the disk is full or
/// another connection reads for longer than kEraseSeconds; another call finishes the work.
void erase_removed(Connection& db);
inline constexpr int kEraseSeconds = 60;

}  // namespace tribodyn::server
