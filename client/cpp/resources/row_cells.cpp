#include "client/cpp/resources/row_cells.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "client/cpp/failure.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

bool is_digit(const std::string& text, std::size_t at) {
  return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0;
}

/// Whether the text has a comma between digits.
bool has_decimal_comma(const std::string& text) {
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == ',' && is_digit(text, i - 1) && is_digit(text, i + 1)) return true;
  }
  return false;
}

std::string with_decimal_points(std::string text) {
  std::replace(text.begin(), text.end(), ',', '.');
  return text;
}

/// Whether the point in a number may separate thousands: in a table with decimal commas, "1.234"
/// may mean 1234, as in "1.234,5".
bool may_be_thousands(const std::string& text) {
  const std::size_t point = text.find('.');
  if (point == std::string::npos) return false;
  if (has_decimal_comma(text)) return true;
  return point > 0 && is_digit(text, point - 1) && is_digit(text, point + 1) &&
         is_digit(text, point + 2) && is_digit(text, point + 3) && !is_digit(text, point + 4);
}

bool holds_numbers(const RowColumn& column) {
  return column.is_number() || column.kind == RowColumn::Kind::kMeasurements ||
         (column.kind == RowColumn::Kind::kProvenance &&
          column.part == RowColumn::Part::kStandardUncertainty);
}

}  // namespace

RowCells::RowCells(const std::string& text, const std::string& path, const Find& find,
                   GroupedComplaints& wrong)
    : path_(path), lines_(read_csv(text)), separator_(csv_separator(text)) {
  std::erase_if(lines_, [](const CsvLine& line) {
    return std::all_of(line.cells.begin(), line.cells.end(),
                       [](const std::string& cell) { return cell.empty(); });
  });
  if (lines_.empty()) throw Failure(kExitUsage, path_ + ": the table is empty");
  read_header(find, wrong);
  check_widths(wrong);
  read_units(wrong);
  read_decimal_commas(wrong);
}

std::string RowCells::row_text(const CsvLine& line) { return "row " + std::to_string(line.number); }

std::string RowCells::column_text(std::size_t k) const { return "column " + printable(header_[k]); }

bool RowCells::is_name(std::size_t k) const {
  return columns_[k] && columns_[k]->field != nullptr && header_of(*columns_[k]) == "name";
}

/// Whether a column has neither a name nor cells; spreadsheets write such columns at the end.
bool RowCells::is_blank(std::size_t k) const {
  return std::all_of(lines_.begin(), lines_.end(), [&](const CsvLine& line) {
    return k >= line.cells.size() || line.cells[k].empty();
  });
}

void RowCells::read_header(const Find& find, GroupedComplaints& wrong) {
  header_ = std::move(lines_.front().cells);
  lines_.erase(lines_.begin());
  while (!header_.empty() && header_.back().empty() && is_blank(header_.size() - 1)) {
    header_.pop_back();
  }
  std::set<std::string> seen;
  for (std::size_t k = 0; k < header_.size(); ++k) {
    std::string complaint;
    std::optional<RowColumn> column = find(header_[k], complaint);
    if (header_[k].empty()) {
      wrong.add("column " + std::to_string(k + 1) + " has no name");
    } else if (!complaint.empty()) {
      wrong.add("column '" + printable(header_[k].substr(0, 100)) + "' " + complaint);
    } else {
      const bool is_as_typed = !column || column->kind == RowColumn::Kind::kColdViscosity;
      const std::string full = is_as_typed ? header_[k] : header_of(*column);
      // A lubricant and a surface have fields of the same name.
      const bool has_field = column && column->field != nullptr;
      const std::string owner = has_field ? column->field->containing_type()->full_name() : "";
      if (!seen.insert(owner + "." + full).second) wrong.add(column_text(k) + " occurs twice");
      columns_by_name_.emplace(full, header_[k]);
    }
    columns_.push_back(std::move(column));
  }
}

void RowCells::check_widths(GroupedComplaints& wrong) {
  for (CsvLine& line : lines_) {
    while (line.cells.size() > header_.size() && line.cells.back().empty()) line.cells.pop_back();
    if (line.cells.size() == header_.size()) continue;
    wrong.add(row_text(line), "",
              "has " + std::to_string(line.cells.size()) + " cells, the header " +
                  std::to_string(header_.size()));
  }
  std::erase_if(lines_, [&](const CsvLine& line) { return line.cells.size() != header_.size(); });
}

/// Whether the line, the first one below the header, holds units: it has no name and units in
/// place of numbers.
bool RowCells::is_units_row(const CsvLine& line) const {
  bool has_unit = false;
  for (std::size_t k = 0; k < header_.size(); ++k) {
    if (!columns_[k]) continue;
    const std::string& cell = line.cells[k];
    if (is_name(k)) {
      const std::string word = plain_word(cell);
      if (!word.empty() && word.find("unit") != 0 && word.find("einheit") != 0) return false;
    }
    if (!columns_[k]->is_number() || cell.empty()) continue;
    const bool is_unit = unit_ratio(cell, cell).has_value() && cell != "1";  // "1/GPa" is one
    if (!is_unit && cell.find_first_of("0123456789") < 2) return false;
    has_unit = true;
  }
  return has_unit;
}

void RowCells::read_units(GroupedComplaints& wrong) {
  if (lines_.empty() || !is_units_row(lines_.front())) return;
  const CsvLine line = lines_.front();
  lines_.erase(lines_.begin());
  for (std::size_t k = 0; k < header_.size(); ++k) {
    if (!columns_[k] || !columns_[k]->is_number() || line.cells[k].empty()) continue;
    std::string unit = line.cells[k];
    if (unit.size() > 2 && (unit.front() == '(' || unit.front() == '[')) {
      unit = unit.substr(1, unit.size() - 2);
    }
    if (unit == "-") continue;
    const bool is_cold = columns_[k]->kind == RowColumn::Kind::kColdViscosity;
    const std::string& name = columns_[k]->field->name();
    const std::string own = is_cold ? "mPa s" : unit_of_field(name);
    std::string complaint;
    if (own.empty() || !read_quantity("1", own, unit, is_temperature_field(name), complaint)) {
      wrong.add(row_text(line), column_text(k),
                "'" + printable(line.cells[k].substr(0, 60)) +
                    "' looks like a unit, but the column takes " +
                    (own.empty() ? "none" : "multiples of " + own) +
                    "; correct it, or begin the row with #");
      continue;
    }
    columns_[k]->bare_unit = unit;
  }
}

/// Calls `use` for every cell of a column of numbers.
template <class Use>
void RowCells::for_each_number(const Use& use) {
  for (CsvLine& line : lines_) {
    for (std::size_t k = 0; k < header_.size(); ++k) {
      if (columns_[k] && holds_numbers(*columns_[k])) use(line, k, line.cells[k]);
    }
  }
}

void RowCells::read_decimal_commas(GroupedComplaints& wrong) {
  std::size_t count = 0;
  std::string first;
  for_each_number([&](const CsvLine& line, std::size_t k, const std::string& cell) {
    if (!has_decimal_comma(cell)) return;
    if (count++ == 0) {
      first = row_text(line) + " " + column_text(k) + ": '" + printable(cell.substr(0, 60)) + "'";
    }
  });
  if (count == 0) return;
  const std::string cells =
      std::to_string(count) + (count == 1 ? " cell has" : " cells have") + " a decimal comma";
  if (separator_ == ',') {
    wrong.add(cells + " (the first: " + first +
              "); use a decimal point, or semicolons between the cells");
    for_each_number([](const CsvLine&, std::size_t, std::string& cell) {
      if (has_decimal_comma(cell)) cell.clear();
    });
    return;
  }
  note_ =
      path_ + ": " + cells + (count == 1 ? " and was" : " and were") + " read with a decimal point";
  for_each_number([&](const CsvLine& line, std::size_t k, std::string& cell) {
    if (may_be_thousands(cell)) {
      wrong.add(row_text(line), column_text(k),
                "'" + printable(cell.substr(0, 60)) +
                    "' has a point in a table of decimal commas; use one of the two and no "
                    "separator of thousands");
      cell.clear();
    } else if (has_decimal_comma(cell)) {
      cell = with_decimal_points(cell);
    }
  });
}

}  // namespace tribodyn::client
