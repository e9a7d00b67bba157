#pragma once

#include <functional>
#include <string>
#include <vector>

#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/row_cells.h"

namespace tribodyn::client {

// A CSV table with one resource per row. Columns: "name", texts and classes; every number under its
// field's name, which ends in the unit, or under its data-sheet name; lists of measurements;
// "FIELD.source" and so on for the origin of a number; "labels.KEY". Gear sets have no such tables:
// each of them is a table.

/// Whether a text is such a table: its header has a column "name", in upper or lower case.
bool is_row_table(const std::string& text);

/// The resources that rows start from.
struct RowBases {
  /// The start of every row; an empty cell leaves its value unchanged. Null: rows start empty.
  const google::protobuf::Message* like = nullptr;
  /// For rows that replace resources: returns the current resource of a name, or null. An empty
  /// cell clears its value. Called only if the table has provenance columns.
  std::function<ResourcePointer(const std::string& name)> present;
};

struct RowTable {
  std::vector<FileResource> resources;  ///< each with its row
  std::string note;                     ///< how cells were read; may be empty
};

/// Returns the resources of a table. An empty cell sets nothing, unless the row has a base. The
/// second row may hold units. A decimal comma is accepted unless commas separate the cells. Throws
/// Failure (kExitUsage) that lists every error with row and column.
RowTable read_row_table(const std::string& text, const std::string& path, const ResourceKind& kind,
                        const RowBases& bases = {});

/// Clears a viscosity law that the resource of a row has from its base if the row states
/// viscosities: the server fits the law to them.
void leave_law_to_viscosities(const RowCells& cells, const CsvLine& line,
                              google::protobuf::Message& resource);

/// Returns the table of these resources: values that were stated or measured, with their origin;
/// cells of values that the server computed are empty. Sets `lost` to the data that a row cannot
/// hold but JSON can and that the model does not need; empty if there are none. Throws Failure
/// (kExitUsage) if a lubricant has boundary friction by temperature.
std::string row_table(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                      std::string& lost);

}  // namespace tribodyn::client
