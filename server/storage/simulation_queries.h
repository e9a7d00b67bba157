#pragma once

#include "server/storage/connection.h"
#include "server/storage/stored_resource.h"
#include "server/storage/stored_simulation.h"

namespace tribodyn::server {

/// The page of simulations that a query means. Without restrictions, and by state or lubricant, it
/// goes along an index from where the last page ended; a label that few have leads. Throws
/// SQLite::Exception.
Page<StoredSimulation> query_simulations(Connection& db, const SimulationQuery& query);

}  // namespace tribodyn::server
