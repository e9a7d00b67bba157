#include "server/resources/imports/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

#include "server/contract/resource_names.h"
#include "server/support/text.h"

namespace tribodyn::server {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

/// Returns the separator that occurs most often in the header.
char separator_of(std::string_view header) {
  char best = ',';
  std::ptrdiff_t most = 0;
  for (const char each : {',', ';', '\t'}) {
    const std::ptrdiff_t count = std::count(header.begin(), header.end(), each);
    if (count > most) {
      most = count;
      best = each;
    }
  }
  return best;
}

/// Returns the cells of a line, or nullopt if a quoted cell does not end or is followed by text.
std::optional<std::vector<std::string>> split(std::string_view line, char separator) {
  std::vector<std::string> cells;
  while (cells.size() <= kMaximumCsvColumns) {
    const std::string_view rest = trimmed(line);
    if (rest.empty() || rest.front() != '"') {
      const std::size_t end = line.find(separator);
      cells.emplace_back(trimmed(line.substr(0, end)));
      if (end == std::string_view::npos) return cells;
      line.remove_prefix(end + 1);
      continue;
    }
    std::string cell;
    std::size_t i = 1;
    for (;; ++i) {
      if (i >= rest.size()) return std::nullopt;
      if (rest[i] == '"') {
        if (i + 1 >= rest.size() || rest[i + 1] != '"') break;
        ++i;
      }
      cell += rest[i];
    }
    cells.push_back(std::move(cell));
    line = rest.substr(i + 1);
    const std::size_t next = line.find_first_not_of(' ');
    if (next == std::string_view::npos) return cells;
    if (line[next] != separator) return std::nullopt;
    line.remove_prefix(next + 1);
  }
  return cells;
}

/// Removes the apostrophe that a CSV file for people has before a text that begins as a formula
/// does.
void remove_guard(std::string& cell) {
  const std::size_t first = cell.find_first_not_of('\'');
  const bool is_guarded = first != 0 && first != std::string::npos &&
                          std::string_view("=+-@\t\r").find(cell[first]) != std::string_view::npos;
  if (is_guarded) cell.erase(0, 1);
}

/// Adds at most kMaximumCsvViolations violations for one text.
class CsvViolations {
 public:
  explicit CsvViolations(Violations& violations) : violations_(violations) {}
  bool full() const { return count_ >= kMaximumCsvViolations; }
  void add(std::string place, std::string text) {
    if (count_++ < kMaximumCsvViolations) {
      violations_.add(std::move(place), std::move(text));
    }
  }

 private:
  Violations& violations_;
  std::size_t count_ = 0;
};

/// Reads a table line by line.
class TableReader {
 public:
  TableReader(CsvTable& table, Violations& violations) : table_(table), limited_(violations) {}

  bool full() const { return limited_.full(); }

  void read(std::string_view line, int number) {
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#') return;
    if (separator_ == '\0') table_.separator = separator_ = separator_of(text);
    auto cells = split(separator_ == '\t' ? line : text, separator_);
    const std::string place = fmt::format("{} row {}", table_.name, number);
    if (!cells) return limited_.add(place, "a quoted cell has no end, or text follows its end");
    for (std::string& each : *cells) remove_guard(each);
    if (table_.columns.empty()) return read_header(std::move(*cells), place);
    if (cells->size() != table_.columns.size()) {
      return limited_.add(place, fmt::format("{} cells; allowed: {}, the number in the header",
                                             cells->size(), table_.columns.size()));
    }
    table_.rows.push_back({number, std::move(*cells)});
  }

 private:
  void read_header(std::vector<std::string> cells, const std::string& place) {
    if (cells.size() > kMaximumCsvColumns) {
      limited_.add(place, fmt::format("more than {} columns", kMaximumCsvColumns));
    }
    table_.columns = std::move(cells);
  }

  CsvTable& table_;
  CsvViolations limited_;
  char separator_ = '\0';
};

/// Returns the header in lower case with blanks and dashes as underscores.
std::string plain_header(std::string_view header) {
  std::string out;
  for (const char c : header) {
    const bool is_gap = c == ' ' || c == '-' || c == '_';
    if (!is_gap) {
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out;
}

/// Returns true if a list with the separator '|' contains the word.
bool list_contains(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    if (take_part(list, '|') == word) return true;
  }
  return false;
}

/// Returns true if the header is that of the form, or one of its names with one of its units: "X
/// (mm)", "Z [\u00b5m]".
bool matches_form(const std::string& header, const CsvColumnForm& form) {
  if (plain_header(header) == form.header) return true;
  const char close = header.empty() ? '\0' : header.back();
  if (close != ')' && close != ']') return false;
  const std::size_t open = header.rfind(close == ')' ? '(' : '[');
  if (open == std::string::npos) return false;
  std::string unit = header.substr(open + 1, header.size() - open - 2);
  for (const std::string_view micro : {"\u00b5", "\u03bc", "\xb5"}) {  // the last one is Latin-1
    if (unit.starts_with(micro)) unit.replace(0, micro.size(), "u");
  }
  for (const std::string_view square : {"\u00b2", "\u00b3"}) {
    if (const std::size_t at = unit.find(square); at != std::string::npos) {
      unit.replace(at, square.size(), square == "\u00b2" ? "2" : "3");
    }
  }
  if (unit.starts_with("\u00b0")) unit.erase(0, 2);
  return list_contains(form.names, plain_header(header.substr(0, open))) &&
         list_contains(form.units, unit);
}

bool has_decimal_comma(std::string_view cell) {
  const std::size_t comma = cell.find(',');
  const auto is_digit = [&](std::size_t at) {
    return at < cell.size() && cell[at] >= '0' && cell[at] <= '9';
  };
  return comma != std::string_view::npos && comma > 0 && is_digit(comma - 1) &&
         is_digit(comma + 1) && cell.find(',', comma + 1) == std::string_view::npos &&
         cell.find('.') == std::string_view::npos;
}

std::optional<double> number_of(std::string_view cell) {
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  const auto value = parse_number<double>(cell);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

std::optional<CsvTable> parse_csv(std::string_view text, const std::string& name,
                                  std::size_t maximum_bytes, Violations& violations) {
  if (text.size() > maximum_bytes) {
    violations.add(name, "{} bytes; allowed: at most {}", text.size(), maximum_bytes);
    return std::nullopt;
  }
  const std::size_t before = violations.size();
  if (text.starts_with("PK\x03\x04") || text.starts_with("\xd0\xcf\x11\xe0")) {
    violations.add(name, "is an Excel workbook; allowed: text, saved as \"CSV UTF-8\"");
    return std::nullopt;
  }
  if (text.find('\0') != std::string_view::npos) {
    const bool is_utf16 = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") ||
                          (text.size() > 1 && (text[0] == '\0') != (text[1] == '\0'));
    violations.add(name, is_utf16 ? "is UTF-16; allowed: UTF-8, saved as \"CSV UTF-8\""
                                  : "is not text: it contains zero bytes");
    return std::nullopt;
  }
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  CsvTable table;
  table.name = name;
  TableReader reader(table, violations);
  for (int number = 1; !text.empty() && !reader.full(); ++number) {
    reader.read(take_part(text, '\n'), number);
  }
  if (!table.rows.empty()) return table;
  if (violations.size() == before) {
    violations.add(name, "has no rows; allowed: a header and at least one row");
  }
  return std::nullopt;
}

std::string csv_place(const CsvTable& table, int line, std::string_view column) {
  return fmt::format("{} row {} column {}", table.name, line, column);
}

std::vector<std::string> headers_of(std::span<const CsvColumnForm> forms) {
  std::vector<std::string> out;
  for (const CsvColumnForm& form : forms) out.emplace_back(form.header);
  return out;
}

std::vector<CsvColumn> match_columns(const CsvTable& table, std::span<const CsvColumnForm> forms,
                                     Violations& violations) {
  std::vector<CsvColumn> out;
  const std::vector<std::string> known = headers_of(forms);
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& header = table.columns[i];
    const auto form = std::find_if(forms.begin(), forms.end(), [&](const CsvColumnForm& each) {
      return matches_form(header, each);
    });
    if (form == forms.end()) {
      violations.add(fmt::format("{} column {}", table.name, i + 1),
                     "\"{}\" is not a known header{}", plain_excerpt(header),
                     meant_text(header, known));
    } else if (find_column(out, form->quantity) != nullptr) {
      violations.add(fmt::format("{} column {}", table.name, header), "{} is given twice",
                     form->quantity);
    } else {
      out.push_back({i, *form});
    }
  }
  return out;
}

const CsvColumn* find_column(const std::vector<CsvColumn>& columns, std::string_view quantity) {
  for (const CsvColumn& column : columns) {
    if (column.form.quantity == quantity) return &column;
  }
  return nullptr;
}

void check_units_row(CsvTable& table, const std::vector<CsvColumn>& columns,
                     Violations& violations) {
  if (table.rows.empty() || columns.empty()) return;
  const CsvTable::Row& row = table.rows.front();
  const bool holds_units =
      std::all_of(columns.begin(), columns.end(), [&](const CsvColumn& column) {
        const std::string& cell = row.cells[column.index];
        return !cell.empty() && cell.find_first_of("0123456789") != 0 && !number_of(cell) &&
               cell.size() < 12 && !has_decimal_comma(cell) && cell.front() != '-';
      });
  if (!holds_units) return;
  violations.add(fmt::format("{} row {}", table.name, row.line),
                 "looks like units (\"{}\"); allowed: numbers. Delete the row, or begin it with #",
                 plain_excerpt(row.cells[columns.front().index]));
  table.rows.erase(table.rows.begin());
}

std::vector<double> numbers(const CsvTable& table, const CsvColumn& column, EmptyCells empty,
                            Violations& violations) {
  /// A text that is not a number, and the rows that contain it.
  struct InvalidCell {
    int first_line = 0, last_line = 0;
    std::size_t count = 0;
    std::string text;
  };
  constexpr char kComma[] = ",";
  std::vector<InvalidCell> invalid_cells;
  std::map<std::string, std::size_t> index;
  const auto add_invalid = [&](const std::string& key, int line, std::string text) {
    const auto [at, is_new] = index.emplace(key, invalid_cells.size());
    if (is_new) invalid_cells.push_back({line, line, 0, std::move(text)});
    invalid_cells[at->second].last_line = line;
    ++invalid_cells[at->second].count;
  };
  std::vector<double> out;
  out.reserve(table.rows.size());
  for (const CsvTable::Row& row : table.rows) {
    std::string cell = row.cells[column.index];
    const bool comma = has_decimal_comma(cell);
    if (comma && table.separator != ',') cell.replace(cell.find(','), 1, ".");
    const std::optional<double> value = number_of(cell);
    out.push_back(value ? column.form.factor * *value + column.form.offset
                        : std::numeric_limits<double>::quiet_NaN());
    if (value || (cell.empty() && empty == EmptyCells::kAreNaN)) continue;
    if (cell.empty()) {
      add_invalid(cell, row.line, "is empty; allowed: a finite number");
    } else {
      add_invalid(
          comma ? kComma : cell, row.line,
          fmt::format("\"{}\"; allowed: a finite number with a decimal point{}",
                      plain_excerpt(cell), comma ? ", or semicolons between the cells" : ""));
    }
  }
  CsvViolations limited(violations);
  for (InvalidCell& each : invalid_cells) {
    if (each.count > 1) {
      each.text +=
          fmt::format(" (and in {} more rows, the last row {})", each.count - 1, each.last_line);
    }
    limited.add(csv_place(table, each.first_line, column.form.header), std::move(each.text));
  }
  return out;
}

}  // namespace tribodyn::server
