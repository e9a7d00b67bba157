#pragma once

#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/simulation_queries.h"
#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// Returns the condition that a campaign is one of the project and satisfies all restrictions, for
/// the clause WHERE of a query of the table campaigns. Keys are those of
/// property_fields("campaigns") and "labels.KEY"; throws std::logic_error for another one.
Condition campaign_condition(Connection& db, const std::string& project,
                             const std::vector<Restriction>& restrictions);

}  // namespace tribodyn::server
