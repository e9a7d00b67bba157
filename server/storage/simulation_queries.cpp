#include "server/storage/simulation_queries.h"

#include <SQLiteCpp/Statement.h>

#include <string>
#include <vector>

#include "server/storage/list_conditions.h"
#include "server/storage/resource_rows.h"
#include "server/storage/simulation_rows.h"

namespace tribodyn::server {
namespace {

/// How many simulations satisfy a condition. Those of a project are counted already.
std::int64_t count_all(Connection& db, const SimulationQuery& query, const std::string& where,
                       const std::vector<PropertyValue>& values) {
  if (query.restrictions.empty()) {
    Prepared counted(db, "SELECT simulations FROM projects WHERE name = ?", query.project);
    return counted.executeStep() ? counted.getColumn(0).getInt64() : 0;
  }
  SQLite::Statement count(db, "SELECT count(*) FROM simulations " + where);
  bind_values(count, values);
  count.executeStep();
  return count.getColumn(0).getInt64();
}

}  // namespace

Page<StoredSimulation> query_simulations(Connection& db, const SimulationQuery& query) {
  const Condition condition = list_condition(db, "simulations", query.project, query.restrictions);
  const std::string where = "WHERE " + condition.sql;
  std::vector<PropertyValue> values = condition.values;
  std::string sql = simulation_columns(RevisionColumns::kRows) + where;
  const std::vector<PropertyValue> all_values = values;
  const std::string direction = query.ascending ? " ASC" : " DESC";
  if (query.after) {
    sql += std::string(" AND (create_time, number) ") + (query.ascending ? ">" : "<") + " (?, ?)";
    values.emplace_back(query.after->create_time);
    values.emplace_back(query.after->number);
  }
  sql += " ORDER BY create_time" + direction + ", number" + direction + " LIMIT ?";
  values.emplace_back(std::int64_t{query.limit + 1});
  const auto run = [&](SQLite::Statement& statement) {
    bind_values(statement, values);
    RevisionNames names(db);
    return read_page<StoredSimulation>(
        statement, query.limit, query.byte_limit, kRequestColumn,
        [&](const SQLite::Statement& row) { return stored_simulation(row, &names); });
  };
  Page<StoredSimulation> page;
  if (query.restrictions.empty()) {
    Prepared statement(db, sql);  // one of four texts
    page = run(statement);
  } else {
    SQLite::Statement statement(db, sql);
    page = run(statement);
  }
  if (query.counts_all) {
    page.total = page.more ? count_all(db, query, where, all_values)
                           : static_cast<std::int64_t>(page.rows.size());
  }
  return page;
}

}  // namespace tribodyn::server
