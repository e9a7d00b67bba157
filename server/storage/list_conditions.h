#pragma once

#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// A condition of an SQL statement and the values of its parameters.
struct Condition {
  std::string sql;
  std::vector<PropertyValue> values;

  void add(const std::string& more, std::vector<PropertyValue> more_values = {}) {
    sql += more;
    values.insert(values.end(), more_values.begin(), more_values.end());
  }
};

/// Returns the comparison of a column with the value of a restriction.
Condition compared(const std::string& column, const Restriction& restriction);

/// Returns the condition that a row of a table, "simulations" or "campaigns", belongs to the
/// project and satisfies all restrictions. Keys are those of property_fields(table) and
/// "labels.KEY"; throws std::logic_error for another one.
Condition list_condition(Connection& db, const std::string& table, const std::string& project,
                         const std::vector<Restriction>& restrictions);

}  // namespace tribodyn::server
