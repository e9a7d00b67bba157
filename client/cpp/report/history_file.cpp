#include "client/cpp/report/history_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "client/cpp/failure.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr std::size_t kIdentityLength = 12;
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

bool is_stream(const std::string& path) {
  struct stat info;
  return stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode);
}

}  // namespace

HistoryFile::HistoryFile(std::string path, Format format, const std::string& identity,
                         std::vector<std::string> columns, std::int64_t rows)
    : path_(std::move(path)), format_(format), columns_(std::move(columns)), target_(path_) {
  const std::string begin = header(rows);
  if (!is_stream(path_)) {
    target_ = path_ + "." + identity.substr(0, kIdentityLength) + ".part";
    rows_there_ = rows_of_part(begin);
  }
  file_.open(target_, std::ios::binary | (rows_there_ > 0 ? std::ios::app : std::ios::trunc));
  if (rows_there_ == 0) file_ << begin;
  check();
}

std::string HistoryFile::header(std::int64_t rows) const {
  return format_ == Format::kCsv ? csv_line(columns_) : numpy_header(columns_, rows);
}

/// Removes an incomplete last row and returns the number of complete rows.
std::int64_t HistoryFile::rows_of_part(const std::string& header) const {
  std::ifstream part(target_, std::ios::binary);
  std::string begin(header.size(), '\0');
  if (!part.read(begin.data(), static_cast<std::streamsize>(begin.size())) || begin != header) {
    return 0;
  }
  std::int64_t rows = 0;
  std::uintmax_t end = header.size();
  if (format_ == Format::kNumpy) {
    const std::uintmax_t width = columns_.size() * sizeof(double);
    rows = static_cast<std::int64_t>((std::filesystem::file_size(target_) - end) / width);
    end += static_cast<std::uintmax_t>(rows) * width;
  } else {
    for (std::string line; std::getline(part, line) && !part.eof(); ++rows) end += line.size() + 1;
  }
  part.close();
  std::filesystem::resize_file(target_, end);
  return rows;
}

void HistoryFile::add(const HistoryRows& rows) {
  file_ << (format_ == Format::kCsv ? csv_rows(rows) : numpy_rows(rows));
  check();
}

void HistoryFile::finish() {
  file_.close();
  check();
  if (target_ == path_) return;
  if (std::rename(target_.c_str(), path_.c_str()) != 0) {
    throw Failure(kExitFailed, "cannot write " + path_ + ": " + std::strerror(errno));
  }
}

void HistoryFile::check() {
  if (!file_) throw Failure(kExitFailed, "cannot write " + target_ + ": " + std::strerror(errno));
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
