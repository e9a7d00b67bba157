#include "server/transport/http/column_text.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>

namespace tribodyn::server {
namespace {

void append_shortest(double value, std::string& out) {
  char text[32];  // the longest double takes 24
  const auto [end, failure] = std::to_chars(text, text + sizeof text, value);
  out.append(text, end);
}

}  // namespace

void append_csv_number(double value, std::string& out) {
  if (!std::isnan(value)) append_shortest(value, out);
}

void append_json_number(double value, std::string& out) {
  if (std::isfinite(value)) return append_shortest(value, out);
  out += std::isnan(value) ? "null" : value > 0 ? "\"Infinity\"" : "\"-Infinity\"";
}

std::string csv_header(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ",") + name;
  return out + "\n";
}

std::string csv_rows(const Columns& columns) {
  std::string out;
  for (std::size_t row = 0; row < columns.front().size(); ++row) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c > 0) out += ',';
      append_csv_number(columns[c][row], out);
    }
    out += '\n';
  }
  return out;
}

std::string numpy_header(const std::vector<std::string>& names, std::int64_t rows) {
  constexpr std::size_t kAlignment = 64;
  std::string fields;
  for (const std::string& name : names) fields += "('" + name + "', '<f8'), ";
  std::string dictionary = "{'descr': [" + fields + "], 'fortran_order': False, 'shape': (" +
                           std::to_string(rows) + ",), }";
  const std::size_t before = 10 + dictionary.size() + 1;
  dictionary.append((kAlignment - before % kAlignment) % kAlignment, ' ');
  dictionary += '\n';
  if (dictionary.size() > 65'535) throw std::length_error("too many columns for NumPy's format");
  std::string out = "\x93NUMPY";
  out += {'\x01', '\x00', static_cast<char>(dictionary.size() & 0xFF),
          static_cast<char>(dictionary.size() >> 8)};
  return out + dictionary;
}

std::string numpy_rows(const Columns& columns) {
  const std::size_t width = columns.size() * sizeof(double);
  std::string out(columns.front().size() * width, '\0');
  for (std::size_t c = 0; c < columns.size(); ++c) {
    char* place = out.data() + c * sizeof(double);
    for (const double value : columns[c]) {
      std::memcpy(place, &value, sizeof value);
      place += width;
    }
  }
  return out;
}

}  // namespace tribodyn::server
