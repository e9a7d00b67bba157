#include "client/cpp/report/history_report.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <vector>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {

namespace {

constexpr char kFlankMark[] = "_flank_";

std::vector<std::string> summary_row(const v1::History::Column& column) {
  std::vector<double> values(column.values().begin(), column.values().end());
  if (zero_means_no_contact(column.name())) std::erase(values, 0.0);
  if (values.empty()) return {column.name(), "0", "-", "-", "-"};
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return {column.name(), std::to_string(values.size()), significant(*least, 6),
          significant(mean, 6), significant(*largest, 6)};
}

}  // namespace

std::string column_quantity(const std::string& column) {
  const std::size_t mark = column.rfind(kFlankMark);
  const bool ends_in_slot = mark != std::string::npos && mark > 0 &&
                            mark + sizeof(kFlankMark) == column.size() &&
                            std::isdigit(static_cast<unsigned char>(column.back())) != 0;
  return ends_in_slot ? column.substr(0, mark) : column;
}

bool zero_means_no_contact(const std::string& column) {
  const std::string quantity = column_quantity(column);
  return quantity != column && !quantity.ends_with("_newtons");
}

std::string history_summary(const v1::History& history) {
  Table table({{"Column", "", Table::Align::kLeft},
               {"samples", ""},
               {"minimum", ""},
               {"mean", ""},
               {"maximum", ""}});
  for (const auto& column : history.columns()) table.add_row(summary_row(column));
  return table.text();
}

std::string history_csv(const v1::History& history, const std::string& warnings) {
  std::vector<std::string> cells;
  int rows = 0;
  for (const auto& column : history.columns()) {
    cells.push_back(column.name());
    rows = std::max(rows, column.values_size());
  }
  cells.emplace_back("warnings");
  std::string text = csv_line(cells);
  for (int row = 0; row < rows; ++row) {
    cells.clear();
    for (const auto& column : history.columns()) {
      cells.push_back(row < column.values_size() ? shortest(column.values(row)) : "");
    }
    cells.push_back(warnings);
    text += csv_line(cells);
  }
  return text;
}

}  // namespace tribodyn::client
