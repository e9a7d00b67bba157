#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/cpp/resources/grouped_complaints.h"
#include "client/cpp/resources/row_columns.h"
#include "client/cpp/text/csv.h"

namespace tribodyn::client {

/// The header and the cells of a CSV table of which columns are fields of resources. The second row
/// may hold units. A decimal comma is accepted unless commas separate the cells.
class RowCells {
 public:
  /// Returns the column of a header. Returns nullopt and sets `wrong` to a complaint, or leaves it
  /// empty for a column whose cells may hold anything.
  using Find =
      std::function<std::optional<RowColumn>(const std::string& header, std::string& wrong)>;

  /// Adds errors to `wrong`. Throws Failure (kExitUsage) if the table is empty.
  RowCells(const std::string& text, const std::string& path, const Find& find,
           GroupedComplaints& wrong);

  const std::vector<std::string>& header() const { return header_; }  ///< as typed
  /// Returns one for each header; nullopt: the column has no field.
  const std::vector<std::optional<RowColumn>>& columns() const { return columns_; }
  /// Returns the rows below header and units, each with as many cells as the header. Numbers have
  /// decimal points.
  const std::vector<CsvLine>& lines() const { return lines_; }
  /// Returns the headers as typed, by the names of their fields.
  const std::map<std::string, std::string>& columns_by_name() const { return columns_by_name_; }
  const std::string& note() const { return note_; }  ///< how cells were read; may be empty

  /// Whether the cells of the column name the rows.
  bool is_name(std::size_t k) const;
  std::string column_text(std::size_t k) const;      ///< "column density15"
  static std::string row_text(const CsvLine& line);  ///< "row 3"

 private:
  bool is_blank(std::size_t k) const;
  void read_header(const Find& find, GroupedComplaints& wrong);
  void check_widths(GroupedComplaints& wrong);
  bool is_units_row(const CsvLine& line) const;
  void read_units(GroupedComplaints& wrong);
  void read_decimal_commas(GroupedComplaints& wrong);
  template <class Use>
  void for_each_number(const Use& use);

  std::string path_;
  std::vector<CsvLine> lines_;
  char separator_;
  std::vector<std::string> header_;
  std::vector<std::optional<RowColumn>> columns_;
  std::map<std::string, std::string> columns_by_name_;
  std::string note_;
};

}  // namespace tribodyn::client
