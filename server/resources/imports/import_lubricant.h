#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::server {

/// The lubricant of a request with the rows of its viscosity table added to its measurements,
/// accepted (accept_resource.h). Columns: lubricants.proto. Violations name row and column.
std::optional<v1::Lubricant> import_lubricant(const v1::ImportLubricantRequest& request,
                                              const std::string& name, const ResourceLookup& lookup,
                                              Violations& violations);

/// Headers that a viscosity table may have.
std::vector<std::string> viscosity_headers();

}  // namespace tribodyn::server
