#include "server/store/retention.h"

#include <vector>

namespace tribodyn::server {
namespace {

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

}  // namespace

int remove_oldest(Connection& db, Microseconds ended_by, int limit) {
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
  for (const Row& row : rows) {
    run(db, "DELETE FROM simulations WHERE id = ?1", row.id);
    run(db,
        "DELETE FROM results WHERE id = ?1 AND "
        "NOT EXISTS (SELECT 1 FROM simulations WHERE result = ?1)",
        row.result);
    run(db,
        "DELETE FROM ledgers WHERE id = ?1 AND "
        "NOT EXISTS (SELECT 1 FROM simulations WHERE ledger = ?1)",
        row.ledger);
  }
  return static_cast<int>(rows.size());
}

std::int64_t used_bytes(Connection& db) {
  const auto pragma = [&db](const char* name) {
    return db.execAndGet(std::string("PRAGMA ") + name).getInt64();
  };
  return (pragma("page_count") - pragma("freelist_count")) * pragma("page_size");
}

}  // namespace tribodyn::server
