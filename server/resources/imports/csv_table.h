#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// A table that a client sent as text: a header line, then rows of as many cells, separated by
/// commas, semicolons or tabs (whichever the header uses), cells in double quotes where they hold
/// one. Empty lines and lines that begin with '#' are skipped; a byte order mark and CRLF are fine.
struct CsvTable {
  std::string name;  ///< of the field it came in, for messages
  char separator = ',';
  std::vector<std::string> columns;
  struct Row {
    int line = 0;  ///< in the text, counted from 1 as editors and spreadsheets do
    std::vector<std::string> cells;
  };
  std::vector<Row> rows;
};

inline constexpr std::size_t kMaximumCsvBytes = 1 << 20;
inline constexpr std::size_t kMaximumProfileBytes = 3 << 20;  ///< of all profiles of a surface
inline constexpr std::size_t kMaximumCsvColumns = 64;
inline constexpr std::size_t kMaximumCsvViolations = 100;

/// Reads a table; violations name the rows that are left out of it because they cannot be read.
/// Nothing when none can; an Excel workbook and UTF-16 are told in one sentence.
std::optional<CsvTable> parse_csv(std::string_view text, const std::string& name,
                                  std::size_t maximum_bytes, Violations& violations);

/// "tooth_contact_csv row 19 column load_share".
std::string csv_place(const CsvTable& table, int line, std::string_view column);

/// A header that stands for a quantity: in SI it is factor * cell + offset.
struct CsvColumnForm {
  std::string_view header;
  std::string_view quantity;
  double factor = 1;
  double offset = 0;
  /// Other headers, a list with a bar between two: "x|position", each with a unit behind it in
  /// brackets out of `units`: "X (mm)".
  std::string_view names = {};
  std::string_view units = {};
};

/// Which column of a table holds a quantity, and how.
struct CsvColumn {
  std::size_t index = 0;
  CsvColumnForm form;
};

/// The columns of a table among the forms it may have, in any case. A header that is none of them
/// is a violation that names the nearest; so is a quantity given twice.
std::vector<CsvColumn> match_columns(const CsvTable& table, std::span<const CsvColumnForm> forms,
                                     Violations& violations);

/// The column of a quantity, or null.
const CsvColumn* find_column(const std::vector<CsvColumn>& columns, std::string_view quantity);

enum class EmptyCells {
  kViolation,
  kAreNaN,
};

/// Takes a first row out that holds units and not numbers, with a violation that says so.
void check_units_row(CsvTable& table, const std::vector<CsvColumn>& columns,
                     Violations& violations);

/// The cells of a column in SI units, NaN for what is no number (and a violation; one for all rows
/// with the same cell). A decimal comma is a point where commas do not separate the cells.
std::vector<double> numbers(const CsvTable& table, const CsvColumn& column, EmptyCells empty,
                            Violations& violations);

}  // namespace tribodyn::server
