#include "client/cpp/report/history_file.h"

#include <cstring>
#include <utility>

#include "client/cpp/failure.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr std::size_t kNumpyAlignment = 64;

/// Returns the header of version 1.0 of the format: magic, length of the dictionary, the dictionary
/// padded with spaces.
std::string numpy_header(const std::vector<std::string>& columns, std::int64_t rows) {
  std::string fields;
  for (const std::string& name : columns) fields += "('" + name + "', '<f8'), ";
  std::string dictionary = "{'descr': [" + fields + "], 'fortran_order': False, 'shape': (" +
                           std::to_string(rows) + ",), }";
  const std::size_t before = 10 + dictionary.size() + 1;
  dictionary.append((kNumpyAlignment - before % kNumpyAlignment) % kNumpyAlignment, ' ');
  dictionary += '\n';
  if (dictionary.size() > 65'535) throw Failure(kExitFailed, "too many columns for NumPy's format");
  std::string out = "\x93NUMPY";
  out += {'\x01', '\x00', static_cast<char>(dictionary.size() & 0xFF),
          static_cast<char>(dictionary.size() >> 8)};
  return out + dictionary;
}

std::string csv_rows(const HistoryRows& rows) {
  std::string out;
  std::vector<std::string> cells(rows.columns.size());
  for (std::size_t row = 0; row < rows.columns.front().size(); ++row) {
    for (std::size_t c = 0; c < cells.size(); ++c) cells[c] = shortest(rows.columns[c][row]);
    out += csv_line(cells);
  }
  return out;
}

/// Returns the rows in the memory order of a structured array: row by row.
std::string numpy_rows(const HistoryRows& rows) {
  const std::size_t width = rows.columns.size() * sizeof(double);
  std::string out(rows.columns.front().size() * width, '\0');
  for (std::size_t c = 0; c < rows.columns.size(); ++c) {
    char* place = out.data() + c * sizeof(double);
    for (const double value : rows.columns[c]) {
      std::memcpy(place, &value, sizeof(double));
      place += width;
    }
  }
  return out;
}

}  // namespace

HistoryFile::HistoryFile(std::string path, Format format, const std::string& identity,
                         std::vector<std::string> columns, std::int64_t rows)
    : format_(format),
      columns_(std::move(columns)),
      file_(std::move(path), identity, header(rows),
            format_ == Format::kCsv ? 0 : columns_.size() * sizeof(double)) {}

std::string HistoryFile::header(std::int64_t rows) const {
  return format_ == Format::kCsv ? csv_line(columns_) : numpy_header(columns_, rows);
}

void HistoryFile::add(const HistoryRows& rows) {
  file_.add(format_ == Format::kCsv ? csv_rows(rows) : numpy_rows(rows));
}

void download_history(Connection& connection, const v1::Simulation& simulation,
                      const std::string& path, HistoryFile::Format format) {
  const v1::SimulationResult& result = simulation.result();
  HistoryFile file(path, format, simulation.input_hash(),
                   {result.history_columns().begin(), result.history_columns().end()},
                   result.history_rows());
  HistoryOptions rest;
  rest.start_row = file.rows_there();
  connection.stream_history(
      simulation.name(), rest, [](const v1::HistorySchema&) {},
      [&file](const HistoryRows& rows) { file.add(rows); });
  file.finish();
}

}  // namespace tribodyn::client
