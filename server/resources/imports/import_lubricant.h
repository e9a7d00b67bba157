#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::server {

/// Adds the rows of the viscosity table to the measurements of the request's lubricant and returns
/// the accepted lubricant (accept_resource.h) with the name `name`. lubricants.proto documents
/// columns. Violations name row and column. Returns nullopt if there is a violation.
std::optional<v1::Lubricant> import_lubricant(const v1::ImportLubricantRequest& request,
                                              const std::string& name, const ResourceLookup& lookup,
                                              Violations& violations);

/// Returns the allowed headers of a viscosity table.
std::vector<std::string> viscosity_headers();

}  // namespace tribodyn::server
