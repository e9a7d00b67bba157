#include "server/mapping/history_columns.h"

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

std::string_view history_column_unit(std::string_view name) {
  struct Unit {
    std::string_view suffix;
    std::string_view symbol;
  };
  // Longest suffix first: "_metres_per_second" before "_per_second".
  static constexpr Unit kUnits[] = {
      {"_radians_per_second", "rad/s"},
      {"_metres_per_second", "m/s"},
      {"_per_second", "1/s"},
      {"_seconds", "s"},
      {"_newton_metres", "N m"},
      {"_metres", "m"},
      {"_newtons", "N"},
      {"_watts", "W"},
      {"_percent", "%"},
      {"_kelvin", "K"},
      {"_pascals", "Pa"},
  };
  const std::string_view quantity = name.substr(0, name.rfind("_flank_"));
  for (const Unit& each : kUnits) {
    if (quantity.ends_with(each.suffix)) return each.symbol;
  }
  return "";
}

}  // namespace tribodyn::server
