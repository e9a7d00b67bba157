#include "client/cpp/report/history_report.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {

std::string history_summary(const v1::HistoryChunk& history) {
  Table table({{"Column", "", Table::Align::kLeft},
               {"samples", ""},
               {"minimum", ""},
               {"mean", ""},
               {"maximum", ""}});
  for (const auto& column : history.columns()) {
    const auto& values = column.values();
    if (values.empty()) {
      table.add_row({column.name(), "0"});
      continue;
    }
    const auto [least, largest] = std::minmax_element(values.begin(), values.end());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / values.size();
    table.add_row({column.name(), std::to_string(values.size()), significant(*least, 6),
                   significant(mean, 6), significant(*largest, 6)});
  }
  return table.text();
}

std::string history_csv(const v1::HistoryChunk& history) {
  std::vector<std::string> cells;
  int rows = 0;
  for (const auto& column : history.columns()) {
    cells.push_back(column.name());
    rows = std::max(rows, column.values_size());
  }
  std::string text = csv_line(cells);
  for (int row = 0; row < rows; ++row) {
    cells.clear();
    for (const auto& column : history.columns()) {
      cells.push_back(row < column.values_size() ? shortest(column.values(row)) : "");
    }
    text += csv_line(cells);
  }
  return text;
}

}  // namespace tribodyn::client
