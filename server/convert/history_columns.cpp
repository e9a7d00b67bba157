#include "server/convert/history_columns.h"

namespace tribodyn::server {

std::optional<HistoryColumn> history_column(std::string_view name) {
  for (int i = 0; i < kHistoryColumns; ++i) {
    const auto column = static_cast<HistoryColumn>(i);
    if (history_column_name(column) == name) return column;
  }
  return std::nullopt;
}

std::vector<std::string> history_column_names() {
  std::vector<std::string> names;
  names.reserve(kHistoryColumns);
  for (int i = 0; i < kHistoryColumns; ++i) {
    names.emplace_back(history_column_name(static_cast<HistoryColumn>(i)));
  }
  return names;
}

}  // namespace tribodyn::server
