#include "client/cpp/resources/row_table.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>

#include "client/cpp/failure.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/resources/grouped_complaints.h"
#include "client/cpp/resources/row_columns.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

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

/// Reads a table row by row.
class RowReader {
 public:
  RowReader(const std::string& text, const std::string& path, const ResourceKind& kind,
            const RowBases& bases)
      : path_(path),
        kind_(kind),
        bases_(bases),
        lines_(read_csv(text)),
        separator_(csv_separator(text)) {
    std::erase_if(lines_, [](const CsvLine& line) {
      return std::all_of(line.cells.begin(), line.cells.end(),
                         [](const std::string& cell) { return cell.empty(); });
    });
  }

  RowTable result() {
    if (lines_.empty()) throw Failure(kExitUsage, path_ + ": the table is empty");
    read_header();
    check_widths();
    read_units();
    look_for_decimal_commas();
    for (const CsvLine& line : lines_) read_row(line);
    if (wrong_.empty() && out_.resources.empty()) wrong_.add("has no rows");
    if (!wrong_.empty()) {
      throw Failure(kExitUsage,
                    path_ + ":\n  " + joined(wrong_.lines(), "\n  ") + "\n  Nothing was written.");
    }
    return std::move(out_);
  }

 private:
  static std::string row_text(const CsvLine& line) { return "row " + std::to_string(line.number); }
  std::string column_text(std::size_t k) const { return "column " + printable(header_[k]); }

  /// Whether a column has neither a name nor cells; spreadsheets write such columns at the end.
  bool is_blank(std::size_t k) const {
    return std::all_of(lines_.begin(), lines_.end(), [&](const CsvLine& line) {
      return k >= line.cells.size() || line.cells[k].empty();
    });
  }

  void read_header() {
    header_ = std::move(lines_.front().cells);
    lines_.erase(lines_.begin());
    while (!header_.empty() && header_.back().empty() && is_blank(header_.size() - 1)) {
      header_.pop_back();
    }
    std::set<std::string> seen;
    for (std::size_t k = 0; k < header_.size(); ++k) {
      std::string wrong;
      std::optional<RowColumn> column = find_column(kind_, header_[k], wrong);
      if (!column) {
        wrong_.add(header_[k].empty()
                       ? "column " + std::to_string(k + 1) + " has no name"
                       : "column '" + printable(header_[k].substr(0, 100)) + "' " + wrong);
      } else {
        const bool is_cold = column->kind == RowColumn::Kind::kColdViscosity;
        const std::string full = is_cold ? header_[k] : header_of(*column);
        if (!seen.insert(full).second) wrong_.add(column_text(k) + " occurs twice");
        columns_by_name_.emplace(full, header_[k]);
        has_provenance_columns_ =
            has_provenance_columns_ || column->kind == RowColumn::Kind::kProvenance;
      }
      columns_.push_back(std::move(column));
    }
  }

  void check_widths() {
    for (CsvLine& line : lines_) {
      while (line.cells.size() > header_.size() && line.cells.back().empty()) line.cells.pop_back();
      if (line.cells.size() == header_.size()) continue;
      wrong_.add(row_text(line), "",
                 "has " + std::to_string(line.cells.size()) + " cells, the header " +
                     std::to_string(header_.size()));
    }
    std::erase_if(lines_, [&](const CsvLine& line) { return line.cells.size() != header_.size(); });
  }

  /// Whether the line, the first one below the header, holds units: it has no name and units in
  /// place of numbers.
  bool is_units_row(const CsvLine& line) const {
    bool has_unit = false;
    for (std::size_t k = 0; k < header_.size(); ++k) {
      if (!columns_[k]) continue;
      const std::string& cell = line.cells[k];
      if (header_of(*columns_[k]) == "name") {
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

  void read_units() {
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
      std::string wrong;
      if (own.empty() || !read_quantity("1", own, unit, is_temperature_field(name), wrong)) {
        wrong_.add(row_text(line), column_text(k),
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
  void for_each_number(const Use& use) {
    for (CsvLine& line : lines_) {
      for (std::size_t k = 0; k < header_.size(); ++k) {
        if (columns_[k] && holds_numbers(*columns_[k])) use(line, k, line.cells[k]);
      }
    }
  }

  void look_for_decimal_commas() {
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
      wrong_.add(cells + " (the first: " + first +
                 "); use a decimal point, or semicolons between the cells");
      for_each_number([](const CsvLine&, std::size_t, std::string& cell) {
        if (has_decimal_comma(cell)) cell.clear();
      });
      return;
    }
    out_.note = path_ + ": " + cells + (count == 1 ? " and was" : " and were") +
                " read with a decimal point";
    for_each_number([&](const CsvLine& line, std::size_t k, std::string& cell) {
      if (may_be_thousands(cell)) {
        wrong_.add(row_text(line), column_text(k),
                   "'" + printable(cell.substr(0, 60)) +
                       "' has a point in a table of decimal commas; use one of the two and no "
                       "separator of thousands");
        cell.clear();
      } else if (has_decimal_comma(cell)) {
        cell = with_decimal_points(cell);
      }
    });
  }

  std::string name_in(const CsvLine& line) const {
    for (std::size_t k = 0; k < header_.size(); ++k) {
      if (columns_[k] && columns_[k]->field != nullptr && header_of(*columns_[k]) == "name") {
        return line.cells[k].empty() ? "" : kind_.name_of(line.cells[k]);
      }
    }
    return "";
  }

  void read_row(const CsvLine& line) {
    FileResource& read = out_.resources.emplace_back(
        FileResource{&kind_, kind_.make(), path_ + " " + row_text(line)});
    bool clears = false;
    if (bases_.like != nullptr) {
      read.resource->CopyFrom(*bases_.like);
    } else if (bases_.present && has_provenance_columns_) {
      if (ResourcePointer present = bases_.present(name_in(line))) {
        read.resource = std::move(present);
        clears = true;
      }
    }
    // Provenance cells come after the number: a new number clears its former provenance.
    for (const bool provenance : {false, true}) {
      for (std::size_t k = 0; k < header_.size(); ++k) {
        if (!columns_[k]) continue;
        if ((columns_[k]->kind == RowColumn::Kind::kProvenance) != provenance) continue;
        set(line, k, clears, *read.resource);
      }
    }
    if (bases_.like != nullptr) leave_law_to_viscosities(line, *read.resource);
    if (text_field(*read.resource, "name").empty()) wrong_.add(row_text(line), "", "has no name");
    for (const char* field : {"name", "derived_from"}) {
      const std::string stated = text_field(*read.resource, field);
      if (!stated.empty()) set_text(*read.resource, field, kind_.name_of(stated));
    }
    if (bases_.like == nullptr) read.fields = fields();
    read.columns = columns_by_name_;
  }

  /// Clears a viscosity law that comes from the base if the row states viscosities: the server fits
  /// the law to them.
  void leave_law_to_viscosities(const CsvLine& line, Message& resource) const {
    bool has_viscosity = false;
    std::set<std::string> stated;
    for (std::size_t k = 0; k < header_.size(); ++k) {
      if (!columns_[k] || columns_[k]->field == nullptr || line.cells[k].empty()) continue;
      const std::string& name = columns_[k]->field->name();
      stated.insert(name);
      has_viscosity = has_viscosity ||
                      (columns_[k]->block != nullptr && name.find("viscosit") != std::string::npos);
    }
    if (!has_viscosity) return;
    constexpr const char* kLaw[] = {"vogel_viscosity_prefactor_pascal_seconds",
                                    "vogel_temperature_coefficient_kelvin",
                                    "vogel_reference_temperature_kelvin"};
    if (std::any_of(std::begin(kLaw), std::end(kLaw),
                    [&](const char* each) { return stated.count(each) != 0; })) {
      return;
    }
    for (const char* each : kLaw) {
      const FieldDescriptor* field = resource.GetDescriptor()->FindFieldByName(each);
      if (field == nullptr) return;
      resource.GetReflection()->ClearField(&resource, field);
      drop_provenance(resource, each);
    }
  }

  void set(const CsvLine& line, std::size_t k, bool clears, Message& resource) {
    const std::string& cell = line.cells[k];
    if (cell.empty()) {
      if (clears) clear_cell(*columns_[k], resource);
      return;
    }
    const std::string wrong = set_cell(*columns_[k], cell, resource);
    if (!wrong.empty()) wrong_.add(row_text(line), column_text(k), wrong);
  }

  /// Returns the fields that the columns set; a field of a nested message as "block.field", so that
  /// an update keeps its other fields.
  std::vector<std::string> fields() const {
    std::set<std::string> out;
    for (const auto& column : columns_) {
      if (column) out.insert(mask_of(*column));
    }
    out.erase("");
    return {out.begin(), out.end()};
  }

  const std::string path_;
  const ResourceKind& kind_;
  const RowBases& bases_;
  std::vector<CsvLine> lines_;
  const char separator_;
  std::vector<std::string> header_;
  std::vector<std::optional<RowColumn>> columns_;  ///< nullopt: unknown
  std::map<std::string, std::string> columns_by_name_;
  bool has_provenance_columns_ = false;
  GroupedComplaints wrong_;
  RowTable out_;
};

/// Whether the resource has tables that a row cannot hold: all but a lubricant's measurements.
bool has_other_tables(const Message& resource) {
  std::vector<const FieldDescriptor*> fields;
  resource.GetReflection()->ListFields(resource, &fields);
  return std::any_of(fields.begin(), fields.end(), [](const FieldDescriptor* field) {
    return field->is_repeated() && !is_output_only(*field) && field->name() != "labels" &&
           field->name() != "provenance";
  });
}

}  // namespace

bool is_row_table(const std::string& text) {
  const std::vector<CsvLine> header = read_csv(text, 1);
  return !header.empty() &&
         std::any_of(header[0].cells.begin(), header[0].cells.end(),
                     [](const std::string& cell) { return plain_word(cell) == "name"; });
}

RowTable read_row_table(const std::string& text, const std::string& path, const ResourceKind& kind,
                        const RowBases& bases) {
  return RowReader(text, path, kind, bases).result();
}

std::string row_table(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                      std::string& lost) {
  std::set<std::string> keys;
  lost.clear();
  for (const ResourcePointer& resource : resources) {
    for (const v1::Label& label : labels_of(*resource)) keys.insert(label.key());
    if (has_other_tables(*resource)) lost = "measured profiles";
  }
  std::vector<RowColumn> columns = columns_of(kind);
  const std::vector<RowColumn> provenance = provenance_columns(resources);
  columns.insert(columns.end(), provenance.begin(), provenance.end());
  for (const std::string& key : keys) {
    RowColumn& column = columns.emplace_back();
    column.kind = RowColumn::Kind::kLabel;
    column.key = key;
  }
  std::vector<std::string> header;
  for (const RowColumn& column : columns) header.push_back(header_of(column));
  std::string text = csv_line(header);
  for (const ResourcePointer& resource : resources) {
    std::vector<std::string> cells;
    for (const RowColumn& column : columns) cells.push_back(cell_of(column, *resource));
    text += csv_line(cells);
  }
  return text;
}

}  // namespace tribodyn::client
