#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "client/cpp/report/part_file.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// A file that receives a history, and resumes as a PartFile does.
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
  std::int64_t rows_there() const { return file_.rows_there(); }
  /// Appends rows.
  void add(const HistoryRows& rows);
  /// Renames the complete file to its final path.
  void finish() { file_.finish(); }

 private:
  std::string header(std::int64_t rows) const;

  const Format format_;
  const std::vector<std::string> columns_;
  PartFile file_;
};

/// Downloads the whole history of a simulation that has succeeded.
void download_history(Connection& connection, const v1::Simulation& simulation,
                      const std::string& path, HistoryFile::Format format);

}  // namespace tribodyn::client
