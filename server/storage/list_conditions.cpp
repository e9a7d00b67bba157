#include "server/storage/list_conditions.h"

#include <SQLiteCpp/Statement.h>
#include <google/protobuf/message.h>
#include <sqlite3.h>

#include <memory>
#include <stdexcept>
#include <variant>

#include "google/api/resource.pb.h"
#include "server/contract/resource_names.h"
#include "server/storage/properties.h"
#include "server/storage/resource_rows.h"
#include "server/storage/resource_types.h"
#include "server/support/value_of.h"

namespace tribodyn::server {
namespace {

using Comparison = Restriction::Comparison;

/// Rows; a label with fewer is looked up before the other conditions.
constexpr int kSelectiveLabelLimit = 1000;
constexpr std::string_view kLabels = "labels.";

constexpr std::pair<Comparison, const char*> kOperators[] = {
    {Comparison::kEqual, "="},   {Comparison::kNotEqual, "<>"},
    {Comparison::kLess, "<"},    {Comparison::kLessOrEqual, "<="},
    {Comparison::kGreater, ">"}, {Comparison::kGreaterOrEqual, ">="}};

/// Returns true if fewer than kSelectiveLabelLimit rows of a table of labels satisfy a condition.
bool is_rare(Connection& db, const std::string& from_labels,
             const std::vector<PropertyValue>& values) {
  SQLite::Statement count(db, "SELECT count(*) FROM (SELECT 1" + from_labels + " LIMIT ?)");
  count.bind(bind_values(count, values) + 1, kSelectiveLabelLimit);
  count.executeStep();
  return count.getColumn(0).getInt() < kSelectiveLabelLimit;
}

Condition label_condition(Connection& db, const std::string& table,
                          const Restriction& restriction) {
  const std::string owner = table.substr(0, table.size() - 1);  // "simulation"
  std::string from_labels = " FROM " + owner + "_labels WHERE key = ?";
  std::vector<PropertyValue> values = {restriction.key.substr(kLabels.size())};
  if (restriction.comparison != Comparison::kPresent) {
    from_labels += " AND value = ?";
    values.push_back(restriction.value);
  }
  const bool is_not = restriction.comparison == Comparison::kNotEqual;
  if (!is_not && is_rare(db, from_labels, values)) {
    return {"id IN (SELECT " + owner + from_labels + ")", values};
  }
  return {std::string(is_not ? "NOT " : "") + "EXISTS (SELECT 1" + from_labels + " AND " + owner +
              " = " + table + ".id)",
          values};
}

/// Adds `display_name(BLOB)` of a stored request to the SQL functions of a connection. No column
/// has it: whoever filters by it reads every request that the rest of the filter leaves.
void add_display_name_function(Connection& db, const std::string& table) {
  db.createFunction(
      "display_name", 1, true, new_resource(table).release(),
      [](sqlite3_context* context, int, sqlite3_value** values) {
        auto& request = *static_cast<google::protobuf::Message*>(sqlite3_user_data(context));
        request.ParseFromArray(sqlite3_value_blob(values[0]), sqlite3_value_bytes(values[0]));
        const std::string name = request.GetReflection()->GetString(
            request, request.GetDescriptor()->FindFieldByName("display_name"));
        sqlite3_result_text(context, name.data(), static_cast<int>(name.size()), SQLITE_TRANSIENT);
      },
      nullptr, nullptr,
      [](void* request) { delete static_cast<google::protobuf::Message*>(request); });
}

Condition one_condition(Connection& db, const std::string& table, const std::string& project,
                        const Restriction& restriction) {
  if (restriction.key.starts_with(kLabels)) return label_condition(db, table, restriction);
  // Keys come from a client's filter, so only the constants of property_fields() enter a statement.
  std::string column;
  for (const PropertyField& field : property_fields(table)) {
    if (field.key == restriction.key) column = field.key;
  }
  if (column.empty()) {
    throw std::logic_error("no column of " + table + " for the key " + restriction.key);
  }
  const auto message = new_resource(table);
  const auto* field = message->GetDescriptor()->FindFieldByName(column);
  if (field->options().HasExtension(google::api::resource_reference)) {
    const bool is_not = restriction.comparison == Comparison::kNotEqual;
    const std::string name = name_in(project, std::get<std::string>(restriction.value));
    return {column + (is_not ? " NOT " : " ") +
                "IN (SELECT revision_id FROM revision_names "
                "WHERE name = ? OR name || '@' || revision = ?)",
            {name, name}};
  }
  if (column == "display_name") {
    add_display_name_function(db, table);
    column = "display_name(request)";
  }
  return compared(column, restriction);
}

}  // namespace

Condition compared(const std::string& column, const Restriction& restriction) {
  if (restriction.comparison == Comparison::kContains) {
    return {"instr(lower(" + column + "), lower(?)) > 0", {restriction.value}};
  }
  if (restriction.comparison == Comparison::kPresent) return {column + " IS NOT NULL", {}};
  const char* const sign = value_of(kOperators, restriction.comparison, "=");
  return {column + " " + sign + " ?", {restriction.value}};
}

Condition list_condition(Connection& db, const std::string& table, const std::string& project,
                         const std::vector<Restriction>& restrictions) {
  Condition out{"project = ?", {project}};
  for (const Restriction& each : restrictions) {
    const Condition next = one_condition(db, table, project, each);
    out.add(" AND " + next.sql, next.values);
  }
  return out;
}

}  // namespace tribodyn::server
