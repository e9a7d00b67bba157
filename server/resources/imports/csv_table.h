#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// A table that a client sent as text: a header line, then rows with the same number of cells.
/// Commas, semicolons or tabs separate cells; the separator is the one that the header uses. A cell
/// that contains the separator is in double quotes. Empty lines and lines that begin with '#' are
/// skipped; a byte order mark and CRLF are accepted.
struct CsvTable {
  std::string name;  ///< field of the request, for violations
  char separator = ',';
  std::vector<std::string> columns;
  struct Row {
    int line = 0;  ///< line of the text, counted from 1
    std::vector<std::string> cells;
  };
  std::vector<Row> rows;
};

inline constexpr std::size_t kMaximumCsvBytes = 1 << 20;
inline constexpr std::size_t kMaximumProfileBytes = 3 << 20;  ///< profiles of a surface
inline constexpr std::size_t kMaximumCsvColumns = 64;
inline constexpr std::size_t kMaximumCsvViolations = 100;

/// Parses a table. Adds a violation for each row that cannot be read and leaves it out. Returns
/// nullopt if no row can be read. Excel workbooks and UTF-16 are refused with one violation.
std::optional<CsvTable> parse_csv(std::string_view text, const std::string& name,
                                  std::size_t maximum_bytes, Violations& violations);

/// Returns the position of a cell, e.g. "tooth_contact_csv row 19 column load_share".
std::string csv_place(const CsvTable& table, int line, std::string_view column);

/// A header and its quantity. The quantity in SI units is factor * cell + offset.
struct CsvColumnForm {
  std::string_view header;
  std::string_view quantity;
  double factor = 1;
  double offset = 0;
  /// Other names, separated by bars: "x|position". A header consists of one of these names and one
  /// of `units` in brackets: "X (mm)".
  std::string_view names = {};
  std::string_view units = {};
};

std::vector<std::string> headers_of(std::span<const CsvColumnForm> forms);

/// The column of a table that holds a quantity, and its form.
struct CsvColumn {
  std::size_t index = 0;
  CsvColumnForm form;
};

/// Returns the columns of a table that have one of `forms`; upper and lower case are equal. Adds a
/// violation for an unknown header, with the nearest known one, and for a quantity that occurs
/// twice.
std::vector<CsvColumn> match_columns(const CsvTable& table, std::span<const CsvColumnForm> forms,
                                     Violations& violations);

/// Returns the column of a quantity, or null if there is none.
const CsvColumn* find_column(const std::vector<CsvColumn>& columns, std::string_view quantity);

/// Meaning of an empty cell.
enum class EmptyCells {
  kViolation,
  kAreNaN,
};

/// Removes a first row that contains units, and adds a violation.
void check_units_row(CsvTable& table, const std::vector<CsvColumn>& columns,
                     Violations& violations);

/// Returns the cells of a column in SI units. A cell that is not a number becomes NaN and a
/// violation; rows with the same text share one violation. Unless commas separate cells, a decimal
/// comma is read as a point.
std::vector<double> numbers(const CsvTable& table, const CsvColumn& column, EmptyCells empty,
                            Violations& violations);

}  // namespace tribodyn::server
