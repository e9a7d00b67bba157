#pragma once

#include <string>
#include <vector>

namespace tribodyn::client {

/// A table for a person: every column as wide as its widest cell.
class Table {
 public:
  /// kDecimal: decimal points one below the other.
  enum class Align { kLeft, kRight, kDecimal };
  struct Column {
    std::string header;
    std::string unit;  ///< second header line; left out when no column has one
    Align align = Align::kRight;
  };

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}
  /// Missing cells are empty. Cells beyond the columns are a mistake of the caller
  /// (std::logic_error).
  void add_row(std::vector<std::string> cells);
  bool empty() const { return rows_.empty(); }
  /// Header, a rule, rows; each line ends in a line feed and carries no trailing blanks.
  std::string text() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// Lines "  label   value unit  note" under a heading; the values of one block are aligned.
class Sheet {
 public:
  void heading(const std::string& text);
  void line(const std::string& label, const std::string& value, const std::string& unit = "",
            const std::string& note = "");
  /// A line of running text, wrapped.
  void remark(const std::string& text);
  std::string text() const;

 private:
  struct Line {
    enum class Kind { kHeading, kValue, kRemark } kind;
    std::string label, value, unit, note;
  };
  std::vector<Line> lines_;
};

}  // namespace tribodyn::client
