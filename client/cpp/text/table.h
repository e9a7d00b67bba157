#pragma once

#include <string>
#include <vector>

namespace tribodyn::client {

/// A table for people to read: every column is as wide as its widest cell.
class Table {
 public:
  /// kDecimal puts the decimal points of a column below one another.
  enum class Align { kLeft, kRight, kDecimal };
  struct Column {
    std::string header;
    std::string unit;  ///< second header line; omitted if no column has a unit
    Align align = Align::kRight;
  };

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}
  /// Adds a row; missing cells are empty. Throws std::logic_error if there are more cells than
  /// columns.
  void add_row(std::vector<std::string> cells);
  bool empty() const { return rows_.empty(); }
  /// Returns header, rule and rows. Each line ends in a line feed and has no trailing blanks.
  std::string text() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// Lines "  label   value unit  note" below headings; the values of one block are aligned.
class Sheet {
 public:
  void heading(const std::string& text);
  void line(const std::string& label, const std::string& value, const std::string& unit = "",
            const std::string& note = "");
  /// Adds running text, which is wrapped.
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
