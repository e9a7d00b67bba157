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

}  // namespace tribodyn::server
