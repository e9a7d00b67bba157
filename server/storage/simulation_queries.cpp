#include "server/storage/simulation_queries.h"

#include <SQLiteCpp/Statement.h>
#include <sqlite3.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "server/storage/properties.h"
#include "server/storage/resource_rows.h"
#include "server/storage/simulation_rows.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {
namespace {

using Comparison = Restriction::Comparison;

/// Simulations; a label with fewer is looked up before the other conditions.
constexpr int kSelectiveLabelLimit = 1000;
constexpr std::string_view kLabels = "labels.";

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

/// Returns the column of a key: the key of a property. Keys come from a client's filter, so only
/// the constants of property_fields() enter a statement.
const std::string& column_of(const std::string& key) {
  for (const PropertyField& field : property_fields("simulations")) {
    if (field.key == key) return field.key;
  }
  throw std::logic_error("no column of simulations for the key " + key);
}

/// Adds `display_name(BLOB)` of a stored request to the SQL functions of a connection. No column
/// has it: whoever filters by it reads every request that the rest of the filter leaves.
void add_display_name_function(Connection& db) {
  db.createFunction(
      "display_name", 1, true, nullptr, [](sqlite3_context* context, int, sqlite3_value** values) {
        v1::Simulation request;
        request.ParseFromArray(sqlite3_value_blob(values[0]), sqlite3_value_bytes(values[0]));
        const std::string& name = request.display_name();
        sqlite3_result_text(context, name.data(), static_cast<int>(name.size()), SQLITE_TRANSIENT);
      });
}

Condition display_name_condition(Connection& db, const Restriction& restriction) {
  add_display_name_function(db);
  if (restriction.comparison == Comparison::kContains) {
    return {"instr(lower(display_name(request)), lower(?)) > 0", {restriction.value}};
  }
  return {"display_name(request) " + operator_of(restriction.comparison) + " ?",
          {restriction.value}};
}

Condition condition(Connection& db, const std::string& project, const Restriction& restriction) {
  if (restriction.key == "display_name") return display_name_condition(db, restriction);
  if (restriction.key.starts_with(kLabels)) return label_condition(db, restriction);
  const bool is_resource = restriction.key == "lubricant" || restriction.key == "gear_set" ||
                           restriction.key == "surface" || restriction.key == "vehicle";
  if (is_resource) {
    const bool is_not = restriction.comparison == Comparison::kNotEqual;
    const std::string name = name_in(project, std::get<std::string>(restriction.value));
    return {restriction.key + (is_not ? " NOT " : " ") +
                "IN (SELECT revision_id FROM revision_names "
                "WHERE name = ? OR name || '@' || revision = ?)",
            {name, name}};
  }
  return {column_of(restriction.key) + " " + operator_of(restriction.comparison) + " ?",
          {restriction.value}};
}

/// How many simulations satisfy a condition. Those of a project are counted already.
std::int64_t count_all(Connection& db, const SimulationQuery& query, const std::string& where,
                       const std::vector<PropertyValue>& values) {
  if (query.restrictions.empty()) {
    Prepared counted(db, "SELECT simulations FROM projects WHERE name = ?");
    counted.bind(1, query.project);
    return counted.executeStep() ? counted.getColumn(0).getInt64() : 0;
  }
  SQLite::Statement count(db, "SELECT count(*) FROM simulations " + where);
  for (std::size_t i = 0; i < values.size(); ++i) {
    bind_value(count, static_cast<int>(i) + 1, values[i]);
  }
  count.executeStep();
  return count.getColumn(0).getInt64();
}

}  // namespace

Condition condition_of(Connection& db, const std::string& project,
                       const std::vector<Restriction>& restrictions) {
  Condition out{"project = ?", {project}};
  for (const Restriction& each : restrictions) {
    Condition next = condition(db, project, each);
    out.sql += " AND " + next.sql;
    out.values.insert(out.values.end(), next.values.begin(), next.values.end());
  }
  return out;
}

Page<StoredSimulation> query_simulations(Connection& db, const SimulationQuery& query) {
  const Condition condition = condition_of(db, query.project, query.restrictions);
  const std::string where = "WHERE " + condition.sql;
  std::vector<PropertyValue> values = condition.values;
  std::string sql = kSimulationColumns + where;
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
    for (std::size_t i = 0; i < values.size(); ++i) {
      bind_value(statement, static_cast<int>(i) + 1, values[i]);
    }
    return read_page<StoredSimulation>(statement, query.limit, query.byte_limit, kRequestColumn,
                                       stored_simulation);
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
