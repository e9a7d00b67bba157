#pragma once

#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/stored_resource.h"
#include "server/storage/stored_simulation.h"

namespace tribodyn::server {

/// A condition of an SQL statement and the values of its parameters.
struct Condition {
  std::string sql;
  std::vector<PropertyValue> values;
};

/// Returns the condition that a row of simulations belongs to the project and satisfies all
/// restrictions.
Condition condition_of(Connection& db, const std::string& project,
                       const std::vector<Restriction>& restrictions);

/// Returns a page of simulations. Without restrictions, and with those on state or lubricant, it
/// reads an index from the end of the previous page. A label that few simulations have is looked up
/// first. Throws SQLite::Exception.
Page<StoredSimulation> query_simulations(Connection& db, const SimulationQuery& query);

}  // namespace tribodyn::server
