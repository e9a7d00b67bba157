#include "server/storage/campaign_conditions.h"

#include <sqlite3.h>

#include <stdexcept>
#include <variant>

#include "server/contract/resource_names.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {
namespace {

constexpr std::string_view kLabelKeys = "labels.";

Condition campaign_label_condition(const Restriction& restriction) {
  std::string where = "key = ?";
  std::vector<PropertyValue> values = {restriction.key.substr(kLabelKeys.size())};
  if (restriction.comparison != Restriction::Comparison::kPresent) {
    where += " AND value = ?";
    values.push_back(restriction.value);
  }
  const bool is_not = restriction.comparison == Restriction::Comparison::kNotEqual;
  return {std::string("id ") + (is_not ? "NOT " : "") +
              "IN (SELECT campaign FROM campaign_labels WHERE " + where + ")",
          values};
}

/// Adds `campaign_display_name(BLOB)` of a stored request to the SQL functions of a connection. No
/// column has it: whoever filters by it reads every request that the rest of the filter leaves.
void add_campaign_name_function(Connection& db) {
  db.createFunction(
      "campaign_display_name", 1, true, nullptr,
      [](sqlite3_context* context, int, sqlite3_value** values) {
        v1::Campaign request;
        request.ParseFromArray(sqlite3_value_blob(values[0]), sqlite3_value_bytes(values[0]));
        const std::string& name = request.display_name();
        sqlite3_result_text(context, name.data(), static_cast<int>(name.size()), SQLITE_TRANSIENT);
      });
}

Condition one_condition(Connection& db, const std::string& project,
                        const Restriction& restriction) {
  const std::string& key = restriction.key;
  const bool is_not = restriction.comparison == Restriction::Comparison::kNotEqual;
  if (key.starts_with(kLabelKeys)) return campaign_label_condition(restriction);
  if (key == "display_name") {
    add_campaign_name_function(db);
    if (restriction.comparison == Restriction::Comparison::kContains) {
      return {"instr(lower(campaign_display_name(request)), lower(?)) > 0", {restriction.value}};
    }
    return {std::string("campaign_display_name(request) ") + (is_not ? "<>" : "=") + " ?",
            {restriction.value}};
  }
  if (key == "state")
    return {std::string("state ") + (is_not ? "<>" : "=") + " ?", {restriction.value}};
  if (key != "lubricant" && key != "gear_set" && key != "surface" && key != "vehicle") {
    throw std::logic_error("no column of campaigns for the key " + key);
  }
  const std::string name = name_in(project, std::get<std::string>(restriction.value));
  return {key + (is_not ? " NOT" : "") +
              " IN (SELECT revision_id FROM revision_names "
              "WHERE name = ? OR name || '@' || revision = ?)",
          {name, name}};
}

}  // namespace

Condition campaign_condition(Connection& db, const std::string& project,
                             const std::vector<Restriction>& restrictions) {
  Condition out{"project = ?", {project}};
  for (const Restriction& each : restrictions) {
    Condition next = one_condition(db, project, each);
    out.sql += " AND " + next.sql;
    out.values.insert(out.values.end(), next.values.begin(), next.values.end());
  }
  return out;
}

}  // namespace tribodyn::server
