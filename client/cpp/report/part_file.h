#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

namespace tribodyn::client {

/// A file that is written row by row. The rows so far are in "<path>.<identity>.part", where a
/// later run with the same identity resumes; finish() renames that file to `path`. A pipe or a
/// device is written directly.
class PartFile {
 public:
  /// `identity` distinguishes contents, e.g. the hash of the inputs. A row has `row_bytes` bytes;
  /// 0: it is a line. Throws Failure.
  PartFile(std::string path, const std::string& identity, const std::string& header,
           std::size_t row_bytes = 0);

  /// Whether the path is that of a pipe or a device.
  static bool is_stream(const std::string& path);

  /// Returns the number of rows that an earlier run left in the file.
  std::int64_t rows_there() const { return rows_there_; }
  const std::string& target() const { return target_; }  ///< path of the file that is written
  /// Appends complete rows. Throws Failure.
  void add(const std::string& rows);
  /// Renames the complete file to its final path. Throws Failure.
  void finish();
  /// Removes the part.
  void discard();

 private:
  std::int64_t rows_of_part(const std::string& header, std::size_t row_bytes) const;
  void check();

  const std::string path_;
  std::string target_;
  std::int64_t rows_there_ = 0;
  std::ofstream file_;
};

}  // namespace tribodyn::client
