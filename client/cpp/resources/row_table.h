#pragma once

#include <functional>
#include <string>
#include <vector>

#include "client/cpp/resources/json_input.h"

namespace tribodyn::client {

// Many resources in one CSV table, a row each: "name", texts and classes, every number under its
// field's name, which ends in its unit, or under its name in the trade, the lists of measurements,
// "FIELD.source" and so on for how a number is known, and "labels.KEY". Not for gear sets, which
// are tables themselves.

/// Whether a text is such a table: its header has a column "name", in any case.
bool is_row_table(const std::string& text);

/// What rows start from.
struct RowBases {
  /// Every row starts as this one; an empty cell leaves it as it is. Null: as nothing.
  const google::protobuf::Message* like = nullptr;
  /// For rows that replace what is there: the present resource of a name, or null. An empty cell
  /// clears. It is asked only where the table tells how numbers are known.
  std::function<ResourcePointer(const std::string& name)> present;
};

struct RowTable {
  std::vector<FileResource> resources;  ///< each with the row that it stands in
  std::string note;                     ///< on how cells were read; may be empty
};

/// The resources of a table. An empty cell is not set, unless the row has a base. A second row of
/// units is understood; in a table that is not separated by commas a decimal comma is, too. Throws
/// Failure (kExitUsage) with everything that cannot be read, row and column named.
RowTable read_row_table(const std::string& text, const std::string& path, const ResourceKind& kind,
                        const RowBases& bases = {});

/// The table of these resources: what was stated and measured, with how it is known; the cells of
/// what the server computed from that are empty. Says in `lost` what a row cannot hold and JSON
/// would; empty for nothing.
std::string row_table(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                      std::string& lost);

}  // namespace tribodyn::client
