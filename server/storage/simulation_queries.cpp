#include "server/storage/simulation_queries.h"

#include <SQLiteCpp/Statement.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "server/storage/resource_rows.h"
#include "server/storage/simulation_rows.h"

namespace tribodyn::server {
namespace {

using Comparison = Restriction::Comparison;

/// Simulations; a label with fewer is looked up before the other conditions.
constexpr int kSelectiveLabelLimit = 1000;
constexpr std::string_view kLabels = "labels.";

/// A condition of an SQL statement and the values of its parameters.
struct Condition {
  std::string sql;
  std::vector<PropertyValue> values;
};

std::string operator_of(Comparison comparison) {
  switch (comparison) {
    case Comparison::kNotEqual:
      return "<>";
    case Comparison::kLess:
      return "<";
    case Comparison::kLessOrEqual:
      return "<=";
    case Comparison::kGreater:
      return ">";
    case Comparison::kGreaterOrEqual:
      return ">=";
    default:
      return "=";
  }
}

/// Returns true if fewer than kSelectiveLabelLimit simulations have a label.
bool is_rare(Connection& db, const std::string& where, const std::vector<PropertyValue>& values) {
  SQLite::Statement count(
      db, "SELECT count(*) FROM (SELECT 1 FROM simulation_labels WHERE " + where + " LIMIT ?)");
  int index = 0;
  for (const PropertyValue& value : values) bind_value(count, ++index, value);
  count.bind(++index, kSelectiveLabelLimit);
  count.executeStep();
  return count.getColumn(0).getInt() < kSelectiveLabelLimit;
}

Condition label_condition(Connection& db, const Restriction& restriction) {
  std::string where = "key = ?";
  std::vector<PropertyValue> values = {restriction.key.substr(kLabels.size())};
  if (restriction.comparison != Comparison::kPresent) {
    where += " AND value = ?";
    values.push_back(restriction.value);
  }
  if (restriction.comparison == Comparison::kNotEqual) {
    return {"NOT EXISTS (SELECT 1 FROM simulation_labels WHERE " + where +
                " AND simulation = simulations.id)",
            values};
  }
  if (is_rare(db, where, values)) {
    return {"id IN (SELECT simulation FROM simulation_labels WHERE " + where + ")", values};
  }
  return {"EXISTS (SELECT 1 FROM simulation_labels WHERE " + where +
              " AND simulation = simulations.id)",
          values};
}

/// Returns the column of a key. Keys come from a client's filter, so only these constants enter a
/// statement.
std::string column_of(const std::string& key) {
  for (const char* column : {"state", "create_time", "pinned"}) {
    if (key == column) return column;
  }
  throw std::logic_error("no column of simulations for the key " + key);
}

Condition condition(Connection& db, const Restriction& restriction) {
  if (restriction.key.starts_with(kLabels)) return label_condition(db, restriction);
  if (restriction.key == "lubricant") {
    const bool is_not = restriction.comparison == Comparison::kNotEqual;
    return {std::string("lubricant ") + (is_not ? "NOT " : "") +
                "IN (SELECT revision_id FROM revision_names "
                "WHERE name = ? OR name || '@' || revision = ?)",
            {restriction.value, restriction.value}};
  }
  return {column_of(restriction.key) + " " + operator_of(restriction.comparison) + " ?",
          {restriction.value}};
}

}  // namespace

Page<StoredSimulation> query_simulations(Connection& db, const SimulationQuery& query) {
  std::string sql = std::string(kSimulationColumns) + "WHERE 1";
  std::vector<PropertyValue> values;
  for (const Restriction& each : query.restrictions) {
    Condition next = condition(db, each);
    sql += " AND " + next.sql;
    values.insert(values.end(), next.values.begin(), next.values.end());
  }
  const std::string direction = query.ascending ? " ASC" : " DESC";
  if (query.after) {
    sql += std::string(" AND (create_time, id) ") + (query.ascending ? ">" : "<") + " (?, ?)";
    values.emplace_back(query.after->create_time);
    values.emplace_back(query.after->id);
  }
  sql += " ORDER BY create_time" + direction + ", id" + direction + " LIMIT ?";
  values.emplace_back(std::int64_t{query.limit + 1});
  SQLite::Statement statement(db, sql);
  for (std::size_t i = 0; i < values.size(); ++i) {
    bind_value(statement, static_cast<int>(i) + 1, values[i]);
  }
  return read_page<StoredSimulation>(statement, query.limit, query.byte_limit, kRequestColumn,
                                     stored_simulation);
}

}  // namespace tribodyn::server
