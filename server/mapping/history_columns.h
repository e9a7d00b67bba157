#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/study/history.h"

namespace tribodyn::server {

/// Returns the column with the name `name` ("mesh_force_newtons"), or nullopt if none exists.
std::optional<HistoryColumn> history_column(std::string_view name);

/// Returns the names of all columns that a request may name.
std::vector<std::string> history_column_names();

/// Returns the symbol of the unit in the name of a stored column or of a figure, e.g. "N" for
/// "flank_load_newtons_flank_1"; empty for a pure number.
std::string_view history_column_unit(std::string_view name);

/// Returns what a column is, e.g. "force of the mesh".
std::string_view history_column_description(HistoryColumn column);

}  // namespace tribodyn::server
