#include "client/cpp/text/csv.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/reflection.h>
#include <google/protobuf/timestamp.pb.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <charconv>

#include "client/cpp/text/text.h"
#include "client/cpp/text/warnings.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::string scalar_text(const Message& message, const FieldDescriptor& field) {
  const auto& reflection = *message.GetReflection();
  if (field.has_presence() && !reflection.HasField(message, &field)) return "";
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return shortest(reflection.GetDouble(message, &field));
    case FieldDescriptor::CPPTYPE_FLOAT:
      return shortest(reflection.GetFloat(message, &field));
    case FieldDescriptor::CPPTYPE_INT32:
      return std::to_string(reflection.GetInt32(message, &field));
    case FieldDescriptor::CPPTYPE_INT64:
      return std::to_string(reflection.GetInt64(message, &field));
    case FieldDescriptor::CPPTYPE_UINT32:
      return std::to_string(reflection.GetUInt32(message, &field));
    case FieldDescriptor::CPPTYPE_UINT64:
      return std::to_string(reflection.GetUInt64(message, &field));
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection.GetBool(message, &field) ? "true" : "false";
    case FieldDescriptor::CPPTYPE_ENUM:
      return reflection.GetEnum(message, &field)->name();
    case FieldDescriptor::CPPTYPE_STRING:
      return reflection.GetString(message, &field);
    case FieldDescriptor::CPPTYPE_MESSAGE:
      break;
  }
  return "";
}

void append_message(const Message& parent, const FieldDescriptor& field, const std::string& name,
                    CsvRow& row) {
  const Message& child = parent.GetReflection()->GetMessage(parent, &field);
  const bool present = parent.GetReflection()->HasField(parent, &field);
  if (field.message_type() == google::protobuf::Timestamp::descriptor()) {
    google::protobuf::Timestamp time;
    time.CopyFrom(child);
    row.emplace_back(name, present ? google::protobuf::util::TimeUtil::ToString(time) : "");
  } else if (field.message_type() == v1::Extremes::descriptor()) {
    for (int i = 0; i < field.message_type()->field_count(); ++i) {
      const FieldDescriptor& part = *field.message_type()->field(i);
      row.emplace_back(part.name() + "_" + name, present ? scalar_text(child, part) : "");
    }
  } else if (present) {
    append_fields(child, name + "_", row);
  } else {
    append_empty_fields(child, name + "_", row);
  }
}

void append_flanks(const Message& parent, const FieldDescriptor& field, const std::string& name,
                   CsvRow& row) {
  const auto& reflection = *parent.GetReflection();
  for (int slot = 0; slot < kFlankSlots; ++slot) {
    const std::string prefix = name + "_" + std::to_string(slot) + "_";
    if (slot < reflection.FieldSize(parent, &field)) {
      append_fields(reflection.GetRepeatedMessage(parent, &field, slot), prefix, row);
    } else {
      append_empty_fields(v1::FlankLoss::default_instance(), prefix, row);
    }
  }
}

/// Whether other programs would misread the bare cell: as several cells, without the blanks at its
/// ends, as a comment, or as the line "sep=" that sets Excel's separator.
bool needs_quotes(std::string_view cell) {
  if (cell.find_first_of(",;\t\"\r\n") != std::string_view::npos) return true;
  return !cell.empty() && (cell.front() == ' ' || cell.back() == ' ' || cell.front() == '#' ||
                           cell.starts_with("sep="));
}

/// Whether a cell, its leading apostrophes aside, begins as a formula does.
bool begins_as_formula(std::string_view cell) {
  const std::size_t first = cell.find_first_not_of('\'');
  return first != std::string_view::npos &&
         std::string_view("=+-@\t\r").find(cell[first]) != std::string_view::npos;
}

bool is_number(std::string_view cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size();
}

}  // namespace

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line, guarded;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line += ',';
    const bool is_formula = begins_as_formula(cells[i]) && !is_number(cells[i]);
    if (is_formula) guarded = "'" + cells[i];
    const std::string& cell = is_formula ? guarded : cells[i];
    const bool is_line = cells.size() == 1 && cell.empty();  // a reader drops an empty line
    if (!is_line && !needs_quotes(cell)) {
      line += cell;
      continue;
    }
    line += '"';
    for (const char c : cell) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + "\n";
}

void append_fields(const Message& message, std::string_view prefix, CsvRow& row) {
  const auto* descriptor = message.GetDescriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor& field = *descriptor->field(i);
    const std::string name = std::string(prefix) + field.name();
    if (field.message_type() == v1::PointSensitivities::descriptor()) continue;
    if (field.is_repeated()) {
      if (field.message_type() == v1::FlankLoss::descriptor()) {
        append_flanks(message, field, name, row);
      } else if (field.message_type() == v1::RangeWarning::descriptor()) {
        row.emplace_back(
            name, codes_of(message.GetReflection()->GetRepeatedFieldRef<v1::RangeWarning>(message,
                                                                                          &field)));
      } else {
        row.emplace_back(name + "_count",
                         std::to_string(message.GetReflection()->FieldSize(message, &field)));
      }
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      append_message(message, field, name, row);
    } else {
      row.emplace_back(name, scalar_text(message, field));
    }
  }
}

void append_empty_fields(const Message& message, std::string_view prefix, CsvRow& row) {
  const std::size_t first = row.size();
  append_fields(message, prefix, row);
  for (std::size_t i = first; i < row.size(); ++i) row[i].second.clear();
}

std::string csv_text(const std::vector<CsvRow>& rows) {
  if (rows.empty()) return "";
  std::vector<std::string> cells;
  for (const auto& [header, value] : rows.front()) cells.push_back(header);
  std::string text = csv_line(cells);
  for (const CsvRow& row : rows) {
    cells.clear();
    for (const auto& [header, value] : row) cells.push_back(value);
    text += csv_line(cells);
  }
  return text;
}

namespace {

/// Whether the line is empty, a comment, or the line "sep=" that sets Excel's separator.
bool is_skipped(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \r");
  return first == std::string_view::npos || line[first] == '#' ||
         (line.starts_with("sep=") && line.size() <= 6);  // 6: a separator and a carriage return
}

/// Returns the first line that is not skipped.
std::string_view header_line(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    if (!is_skipped(line)) return line;
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return {};
}

/// Reads a CSV text cell by cell.
class CsvReader {
 public:
  explicit CsvReader(std::string_view text) : rest_(text), separator_(csv_separator(text)) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
  }

  bool at_end() const { return rest_.empty(); }

  CsvLine line() {
    CsvLine out{line_, {}};
    while (add_cell(out.cells)) {
    }
    return out;
  }

  /// Skips an empty line or a comment; returns false if there is none.
  bool skip() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    if (!is_skipped(line)) return false;
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    return true;
  }

 private:
  /// Returns false after the last cell of a line.
  bool add_cell(std::vector<std::string>& cells) {
    std::string& cell = cells.emplace_back();
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
    const bool quoted = !rest_.empty() && rest_.front() == '"';
    if (quoted) read_quoted(cell);
    const std::size_t kept = cell.size();  // keeps blanks that were quoted
    const std::size_t end =
        std::min(rest_.find_first_of(std::string{separator_, '\n'}), rest_.size());
    cell += rest_.substr(0, end);
    const bool more = end < rest_.size() && rest_[end] == separator_;
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (!more) ++line_;
    const auto is_blank = [](char c) { return c == ' ' || c == '\r'; };
    while (cell.size() > kept && is_blank(cell.back())) cell.pop_back();
    if (cell.starts_with('\'') && begins_as_formula(cell)) cell.erase(0, 1);
    return more;
  }

  void read_quoted(std::string& cell) {
    std::size_t at = 1;
    for (; at < rest_.size(); ++at) {
      if (rest_[at] == '"' && (at + 1 >= rest_.size() || rest_[++at] != '"')) break;
      if (rest_[at] == '\n') ++line_;
      cell += rest_[at];
    }
    rest_.remove_prefix(std::min(at, rest_.size()));
    if (!rest_.empty() && rest_.front() == '"') rest_.remove_prefix(1);
  }

  std::string_view rest_;
  const char separator_;
  int line_ = 1;
};

}  // namespace

char csv_separator(std::string_view text) {
  const std::string_view header = header_line(text);
  char separator = ',';
  std::ptrdiff_t most = 0;
  for (const char each : {',', ';', '\t'}) {
    const std::ptrdiff_t count = std::count(header.begin(), header.end(), each);
    if (count <= most) continue;
    most = count;
    separator = each;
  }
  return separator;
}

std::vector<CsvLine> read_csv(std::string_view text, std::size_t most) {
  CsvReader reader(text);
  std::vector<CsvLine> lines;
  while (!reader.at_end() && lines.size() < most) {
    if (!reader.skip()) lines.push_back(reader.line());
  }
  return lines;
}

}  // namespace tribodyn::client
