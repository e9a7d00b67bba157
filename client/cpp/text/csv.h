#pragma once

#include <google/protobuf/message.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tribodyn::client {

/// One CSV line (RFC 4180 with a plain line feed). Quotes cells that readers would not take as they
/// are: with a separator, quote or line break in them, with blanks around them, or like a note.
std::string csv_line(const std::vector<std::string>& cells);

/// A line of a CSV text that was read.
struct CsvLine {
  int number = 0;  ///< of its first line in the text, from 1
  std::vector<std::string> cells;
};

/// What separates the cells of a CSV text: of comma, semicolon and tab the one that the header has
/// most of.
char csv_separator(std::string_view text);

/// The lines of a CSV text, at most so many: cells separated by csv_separator(); in quotes they may
/// hold anything. Empty lines and those that begin with '#' are left out, as are blanks around
/// cells and a byte order mark.
std::vector<CsvLine> read_csv(std::string_view text, std::size_t most = SIZE_MAX);

/// A row under construction: each cell with its header.
using CsvRow = std::vector<std::pair<std::string, std::string>>;

/// Appends every field of a message, nested ones flattened, numbers as their shortest exact text,
/// unset optional fields empty. The headers depend on the type alone, never on the values, and keep
/// their unit suffix: an Extremes field "film_ratio" gives "minimum_film_ratio" and so on; a
/// repeated field of at most `kFlankSlots` numbered parts (FlankLoss) is written out, of any other
/// only the count is given.
void append_fields(const google::protobuf::Message& message, std::string_view prefix, CsvRow& row);
inline constexpr int kFlankSlots = 3;
/// The same headers with empty cells.
void append_empty_fields(const google::protobuf::Message& message, std::string_view prefix,
                         CsvRow& row);

/// Header line and rows. All rows must have the same headers.
std::string csv_text(const std::vector<CsvRow>& rows);

}  // namespace tribodyn::client
