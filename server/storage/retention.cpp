#include "server/storage/retention.h"

#include <vector>

#include "server/storage/campaign_rows.h"
#include "server/storage/removal.h"

namespace tribodyn::server {
namespace {

/// Bytes that the removal of a simulation frees in addition to the stored_bytes of its result: 780
/// of its row, its events and their indexes, less 70 of the event that tells of its deletion, and
/// 400 of the row of the result. Measured over 1,000 points by dbstat; what the columns of the
/// project add, over 20,000 rows by the size of the tables.
constexpr std::int64_t kBytesOfASimulation = 1110;

}  // namespace

Removed remove_oldest(Connection& db, Microseconds ended_by, int limit) {
  Prepared query(db,
                 "SELECT id, end_time FROM simulations "
                 "WHERE state >= 3 AND pinned = 0 AND end_time <= ? "
                 "ORDER BY end_time LIMIT ?",
                 ended_by, limit);
  std::vector<std::int64_t> oldest;
  Microseconds newest = ended_by;  // of those that go, if there are as many as may go
  while (query.executeStep()) {
    oldest.push_back(query.getColumn(0).getInt64());
    if (oldest.size() == static_cast<std::size_t>(limit)) newest = query.getColumn(1).getInt64();
  }
  query.reset();
  Removed removed;
  Prepared campaigns(db,
                     "SELECT id FROM campaigns WHERE state >= 3 AND end_time <= ? "
                     "ORDER BY end_time LIMIT 1",
                     newest);
  if (campaigns.executeStep()) {
    const std::int64_t id = campaigns.getColumn(0).getInt64();
    campaigns.reset();
    ++removed.campaigns;
    removed.bytes += remove_campaign(db, id);
  }
  for (const std::int64_t id : oldest) {
    ++removed.simulations;
    removed.bytes += kBytesOfASimulation + remove_simulation(db, id);
  }
  return removed;
}

std::int64_t removable_bytes(Connection& db) {
  // The index avoids reading the bodies, which precede the size in a row.
  constexpr char kBytesOfResults[] =
      "SELECT coalesce(sum(stored_bytes), 0) FROM results INDEXED BY results_by_size";
  constexpr char kBytesOfPinned[] =
      "SELECT coalesce(sum(stored_bytes), 0) FROM results INDEXED BY results_by_size "
      "WHERE id IN (SELECT result FROM simulations WHERE pinned = 1)";
  constexpr char kCountOfRemovable[] =
      "SELECT count(*) FROM simulations INDEXED BY ended_simulations "
      "WHERE state >= 3 AND pinned = 0";
  constexpr char kBytesOfCampaigns[] =
      "SELECT coalesce(sum(stored_bytes), 0) FROM campaigns INDEXED BY ended_campaigns "
      "WHERE state >= 3";
  return db.execAndGet(kBytesOfResults).getInt64() - db.execAndGet(kBytesOfPinned).getInt64() +
         kBytesOfASimulation * db.execAndGet(kCountOfRemovable).getInt64() +
         db.execAndGet(kBytesOfCampaigns).getInt64();
}

std::int64_t used_bytes(Connection& db) {
  const auto pragma = [&db](const char* name) {
    return db.execAndGet(std::string("PRAGMA ") + name).getInt64();
  };
  return (pragma("page_count") - pragma("freelist_count")) * pragma("page_size");
}

}  // namespace tribodyn::server
