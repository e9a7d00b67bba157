#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/study/history.h"

namespace tribodyn::server {

/// The column of that name ("mesh_force_newtons"), or nothing.
std::optional<HistoryColumn> history_column(std::string_view name);

/// Names of all columns that can be asked for.
std::vector<std::string> history_column_names();

/// Symbol of the unit that a stored column's name ends in, "N" of "flank_load_newtons_flank_1";
/// empty for a pure number.
std::string_view history_column_unit(std::string_view name);

}  // namespace tribodyn::server
