#include "server/storage/retention.h"

#include <vector>

namespace tribodyn::server {
namespace {

/// Bytes that a simulation takes beside the stored_bytes of its result: 620 for its row, its events
/// and their indexes, 380 for the row of the result. Measured by dbstat over 1,000 points.
constexpr std::int64_t kBytesOfASimulation = 1000;

struct Row {
  std::int64_t id = 0;
  std::int64_t result = 0;  ///< 0: none
  std::int64_t ledger = 0;
};

void run(Connection& db, const char* sql, std::int64_t row) {
  Prepared statement(db, sql);
  statement.bind(1, row);
  statement.exec();
}

/// Removes a result unless a simulation has it; the bytes that were freed.
std::int64_t remove_unused_result(Connection& db, std::int64_t result) {
  Prepared remove(db,
                  "DELETE FROM results WHERE id = ?1 AND "
                  "NOT EXISTS (SELECT 1 FROM simulations WHERE result = ?1) "
                  "RETURNING stored_bytes");
  remove.bind(1, result);
  if (!remove.executeStep()) return 0;
  const std::int64_t bytes = remove.getColumn(0).getInt64();
  remove.executeStep();  // to its end: only then is it done
  return bytes;
}

}  // namespace

Removed remove_oldest(Connection& db, Microseconds ended_by, int limit) {
  Prepared query(db,
                 "SELECT id, coalesce(result, 0), coalesce(ledger, 0) FROM simulations "
                 "WHERE state >= 3 AND pinned = 0 AND end_time <= ? "
                 "ORDER BY end_time LIMIT ?");
  query.bind(1, ended_by);
  query.bind(2, limit);
  std::vector<Row> rows;
  while (query.executeStep()) {
    rows.push_back({query.getColumn(0).getInt64(), query.getColumn(1).getInt64(),
                    query.getColumn(2).getInt64()});
  }
  query.reset();
  Removed removed;
  for (const Row& row : rows) {
    run(db, "DELETE FROM simulations WHERE id = ?1", row.id);
    ++removed.simulations;
    removed.bytes += kBytesOfASimulation + remove_unused_result(db, row.result);
    run(db,
        "DELETE FROM ledgers WHERE id = ?1 AND "
        "NOT EXISTS (SELECT 1 FROM simulations WHERE ledger = ?1)",
        row.ledger);
  }
  return removed;
}

std::int64_t removable_bytes(Connection& db) {
  // The index saves the way through the bodies, behind which the size is stored.
  constexpr char kBytesOfResults[] =
      "SELECT coalesce(sum(stored_bytes), 0) FROM results INDEXED BY results_by_size";
  constexpr char kBytesOfPinned[] =
      "SELECT coalesce(sum(stored_bytes), 0) FROM results INDEXED BY results_by_size "
      "WHERE id IN (SELECT result FROM simulations WHERE pinned = 1)";
  constexpr char kCountOfRemovable[] =
      "SELECT count(*) FROM simulations INDEXED BY ended_simulations "
      "WHERE state >= 3 AND pinned = 0";
  return db.execAndGet(kBytesOfResults).getInt64() - db.execAndGet(kBytesOfPinned).getInt64() +
         kBytesOfASimulation * db.execAndGet(kCountOfRemovable).getInt64();
}

std::int64_t used_bytes(Connection& db) {
  const auto pragma = [&db](const char* name) {
    return db.execAndGet(std::string("PRAGMA ") + name).getInt64();
  };
  return (pragma("page_count") - pragma("freelist_count")) * pragma("page_size");
}

}  // namespace tribodyn::server
