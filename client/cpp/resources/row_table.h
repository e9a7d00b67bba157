#pragma once

#include <string>
#include <vector>

#include "client/cpp/resources/json_input.h"

namespace tribodyn::client {

// Many resources in one CSV table, a row each: "name", texts and classes, every number under its
// field's name, which ends in its unit, and "labels.KEY". Not for gear sets, which are tables
// themselves.

/// Whether a text is such a table: its header has a column "name".
bool is_row_table(const std::string& text);

/// The resources of a table, each with the row that it stands in. An empty cell is not set. Throws
/// Failure (kExitUsage) with everything that cannot be read, row and column named.
std::vector<FileResource> read_row_table(const std::string& text, const std::string& path,
                                         const ResourceKind& kind);

/// The table of these resources. What the server had computed is left out where a row holds what
/// it was computed from. Says in `lost` what a row cannot hold and JSON would.
std::string row_table(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                      std::string& lost);

}  // namespace tribodyn::client
