#include "client/cpp/text/table.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <utility>

#include "client/cpp/text/colour.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

std::string padded(const std::string& text, int width, Table::Align align) {
  const std::string blanks(std::max(0, width - display_width(text)), ' ');
  return align == Table::Align::kLeft ? text + blanks : blanks + text;
}

/// Returns how many characters of a number follow its integer part; 0 for any other text.
int fraction_width(const std::string& cell) {
  const std::size_t point = cell.find('.');
  const bool is_number =
      !cell.empty() && std::isdigit(static_cast<unsigned char>(cell.back())) != 0;
  return !is_number || point == std::string::npos ? 0 : static_cast<int>(cell.size() - point);
}

/// Appends blanks to each number so that right-aligned decimal points are below one another.
void align_decimal_points(std::size_t column, std::vector<std::vector<std::string>>& rows) {
  int widest = 0;
  for (const auto& row : rows) widest = std::max(widest, fraction_width(row[column]));
  for (auto& row : rows) {
    std::string& cell = row[column];
    if (cell.empty() || std::isdigit(static_cast<unsigned char>(cell.back())) == 0) continue;
    cell.append(static_cast<std::size_t>(widest - fraction_width(cell)), ' ');
  }
}

std::string without_trailing_blanks(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

}  // namespace

void Table::add_row(std::vector<std::string> cells) {
  if (cells.size() > columns_.size()) throw std::logic_error("more cells than columns");
  for (std::string& cell : cells) cell = printable(cell);
  cells.resize(columns_.size());
  rows_.push_back(std::move(cells));
}

std::string Table::text() const {
  std::vector<std::vector<std::string>> rows = rows_;
  std::vector<int> widths;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (columns_[c].align == Align::kDecimal) align_decimal_points(c, rows);
    int width = std::max(display_width(columns_[c].header), display_width(columns_[c].unit));
    for (const auto& row : rows) width = std::max(width, display_width(row[c]));
    widths.push_back(width);
  }
  std::string result;
  const auto add_line = [&](const auto& cell) {
    std::string line;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      line += (c == 0 ? "" : "  ") + padded(cell(c), widths[c], columns_[c].align);
    }
    result += without_trailing_blanks(std::move(line)) + "\n";
  };
  add_line([&](std::size_t c) { return columns_[c].header; });
  if (std::any_of(columns_.begin(), columns_.end(),
                  [](const Column& column) { return !column.unit.empty(); })) {
    add_line([&](std::size_t c) { return columns_[c].unit; });
  }
  add_line([&](std::size_t c) { return std::string(widths[c], '-'); });
  for (const auto& row : rows) {
    add_line([&](std::size_t c) { return row[c]; });
  }
  return result;
}

void Sheet::heading(const std::string& text) {
  lines_.push_back({Line::Kind::kHeading, printable(text), "", "", ""});
}

void Sheet::line(const std::string& label, const std::string& value, const std::string& unit,
                 const std::string& note) {
  lines_.push_back({Line::Kind::kValue, printable(label), printable(value), unit, printable(note)});
}

void Sheet::remark(const std::string& text) {
  lines_.push_back({Line::Kind::kRemark, printable(text), "", "", ""});
}

std::string Sheet::text() const {
  int label_width = 0;
  int value_width = 0;
  int unit_width = 0;
  for (const Line& line : lines_) {
    if (line.kind != Line::Kind::kValue) continue;
    label_width = std::max(label_width, display_width(line.label));
    // Aligns only numbers (lines with a unit or a note): a long name would push them to the right.
    if (line.unit.empty() && line.note.empty()) continue;
    value_width = std::max(value_width, display_width(line.value));
    unit_width = std::max(unit_width, display_width(line.unit));
  }
  std::string result;
  for (const Line& line : lines_) {
    switch (line.kind) {
      case Line::Kind::kHeading:
        result += (result.empty() ? "" : "\n") + tribodyn::client::heading(line.label) + "\n";
        break;
      case Line::Kind::kRemark:
        result += wrapped(line.label, 2);
        break;
      case Line::Kind::kValue: {
        std::string text = "  " + padded(line.label, label_width, Table::Align::kLeft) + "  ";
        if (line.unit.empty() && line.note.empty()) {
          text += line.value;
        } else {
          text += padded(line.value, value_width, Table::Align::kRight) + " " +
                  padded(line.unit, unit_width, Table::Align::kLeft) + "  " + line.note;
        }
        result += without_trailing_blanks(std::move(text)) + "\n";
      }
    }
  }
  return result;
}

}  // namespace tribodyn::client
