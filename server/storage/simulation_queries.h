#pragma once

#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/stored_resource.h"
#include "server/storage/stored_simulation.h"

namespace tribodyn::server {

/// Returns a page of simulations. Without restrictions, and with those on state or lubricant, it
/// reads an index from the end of the previous page. A label that few simulations have is looked up
/// first. Throws SQLite::Exception.
Page<StoredSimulation> query_simulations(Connection& db, const SimulationQuery& query);

}  // namespace tribodyn::server
