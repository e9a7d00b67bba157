#pragma once

#include "server/store/connection.h"
#include "server/store/stored_resource.h"
#include "server/store/stored_simulation.h"

namespace tribodyn::server {

/// The page of simulations that a query means. Without restrictions, and by state or lubricant, it
/// goes along an index from where the last page ended; a label that few have leads. Throws
/// SQLite::Exception.
Page<StoredSimulation> query_simulations(Connection& db, const SimulationQuery& query);

}  // namespace tribodyn::server
