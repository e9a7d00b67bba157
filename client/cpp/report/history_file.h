#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// A file that receives a history. The rows so far are in "<path>.<identity>.part", where a later
/// download of the same history resumes; finish() renames that file to `path`. A pipe or a device
/// is written directly.
class HistoryFile {
 public:
  enum class Format {
    kCsv,    ///< a line per row; the headers are the columns' names, with units
    kNumpy,  ///< .npy of a structured array: numpy.load(path)["mesh_force_newtons"]
  };

  /// `identity` distinguishes histories, e.g. the hash of the inputs. Throws Failure.
  HistoryFile(std::string path, Format format, const std::string& identity,
              std::vector<std::string> columns, std::int64_t rows);

  /// Returns the number of rows that an earlier download left in the file.
  std::int64_t rows_there() const { return rows_there_; }
  /// Appends rows.
  void add(const HistoryRows& rows);
  /// Renames the complete file to its final path.
  void finish();

 private:
  std::string header(std::int64_t rows) const;
  std::int64_t rows_of_part(const std::string& header) const;
  void check();

  const std::string path_;
  const Format format_;
  const std::vector<std::string> columns_;
  std::string target_;  ///< path of the file that is written
  std::int64_t rows_there_ = 0;
  std::ofstream file_;
};

/// Downloads the whole history of a simulation that has succeeded.
void download_history(Connection& connection, const v1::Simulation& simulation,
                      const std::string& path, HistoryFile::Format format);

}  // namespace tribodyn::client
