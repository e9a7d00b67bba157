#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tribodyn::server {

// What the process and its files take of the machine. A value that the system does not tell is
// nullopt or missing.

struct ProcessUse {
  double cpu_seconds = 0;
  double maximum_files = 0;
  std::optional<double> open_files;
  std::optional<double> resident_bytes;
  std::optional<double> threads;
  std::optional<double> start_time_seconds;  ///< since 1970
};
ProcessUse process_use();

/// A file and its name in the metrics.
struct NamedFile {
  std::string name;
  std::filesystem::path path;
};

struct DiskUse {
  std::optional<double> size_bytes;  ///< of the file system of the first file
  std::optional<double> free_bytes;  ///< of it, for those who are not root
  std::map<std::string, double> file_bytes;
};
DiskUse disk_use(const std::vector<NamedFile>& files);

}  // namespace tribodyn::server
