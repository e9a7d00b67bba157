#pragma once

#include <google/protobuf/message.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tribodyn::client {

/// Returns one CSV line (RFC 4180, but with a plain line feed). Quotes a cell that other programs
/// would misread: one that holds a separator, quote or line break, has blanks at its ends, or looks
/// like a comment. A text that a spreadsheet would compute, as it begins with =, +, -, @, a tab or
/// a carriage return, gets a leading apostrophe, which read_csv() removes; a number gets none.
std::string csv_line(const std::vector<std::string>& cells);

/// One line of a CSV text.
struct CsvLine {
  int number = 0;  ///< line number in the text, from 1; of a record with line breaks, the number of
                   ///< its first line
  std::vector<std::string> cells;
};

/// Returns the separator of a CSV text: the one of comma, semicolon and tab that is most frequent
/// in the header.
char csv_separator(std::string_view text);

/// Returns the first `most` lines of a CSV text. The server's reader
/// (resources/imports/csv_table.h) is apart: it limits and judges the text of strangers, and the
/// client links nothing of the server.
///  csv_separator() separates the cells; a quoted cell
/// may hold any text. Drops empty lines, lines that begin with '#', blanks around cells and a byte
/// order mark.
std::vector<CsvLine> read_csv(std::string_view text, std::size_t most = SIZE_MAX);

/// A row under construction: pairs of header and cell.
using CsvRow = std::vector<std::pair<std::string, std::string>>;

/// Appends every field of a message as a cell. Nested messages are flattened, numbers are written
/// as their shortest exact text, unset optional fields are empty. The headers depend only on the
/// message's type and keep the unit suffix. An Extremes field "film_ratio" gives
/// "minimum_film_ratio" and so on. A repeated field of at most `kFlankSlots` numbered parts
/// (FlankLoss) is written part by part, of warnings the codes; of any other repeated field only the
/// count.
/// Sensitivities are left out: sensitivity_report.h makes cells of them.
void append_fields(const google::protobuf::Message& message, std::string_view prefix, CsvRow& row);
inline constexpr int kFlankSlots = 3;
/// Appends the headers of append_fields(), each with an empty cell.
void append_empty_fields(const google::protobuf::Message& message, std::string_view prefix,
                         CsvRow& row);

/// Returns a header line and one line per row. All rows must have the same headers.
std::string csv_text(const std::vector<CsvRow>& rows);

}  // namespace tribodyn::client
