#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// A history on its way into a file. What came so far is kept under "<path>.<identity>.part", where
/// a later download of the same goes on; the file itself appears when all rows are there. A pipe or
/// a device is written to as it is.
class HistoryFile {
 public:
  enum class Format {
    kCsv,    ///< a line a row; headers are the columns' names, which carry their units
    kNumpy,  ///< .npy of a structured array: numpy.load(path)["mesh_force_newtons"]
  };

  /// `identity` tells one history from another, e.g. the hash of its inputs. Throws Failure.
  HistoryFile(std::string path, Format format, const std::string& identity,
              std::vector<std::string> columns, std::int64_t rows);

  /// Rows that an earlier download left there.
  std::int64_t rows_there() const { return rows_there_; }
  /// Appends rows.
  void add(const HistoryRows& rows);
  /// Puts the file in its place.
  void finish();

 private:
  std::string header(std::int64_t rows) const;
  std::int64_t rows_of_part(const std::string& header) const;
  void check();

  const std::string path_;
  const Format format_;
  const std::vector<std::string> columns_;
  std::string target_;  ///< what is written to
  std::int64_t rows_there_ = 0;
  std::ofstream file_;
};

/// Downloads the whole history of a simulation that has succeeded.
void download_history(Connection& connection, const v1::Simulation& simulation,
                      const std::string& path, HistoryFile::Format format);

}  // namespace tribodyn::client
