#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tribodyn::server {

/// Throws StoreError kCannotOpen if a server must not open or create a database at the path: it is
/// not a file, or it does not exist although a file beside it shows that a database existed (a
/// write-ahead log, a database that a restore kept, the unfinished copy of a restore). A new
/// database would hide the loss.
void require_usable_path(const std::filesystem::path& database);

/// The database file and its write-ahead log at the time when a server opened them. Safe for
/// concurrent access.
class DatabaseFiles {
 public:
  /// Requires that both files exist. Throws StoreError kFailed.
  explicit DatabaseFiles(const std::filesystem::path& database);

  /// Returns a sentence for the operator if one of the paths now has another file or none: writes
  /// to the open files would be lost. Returns an empty string otherwise.
  std::string misplaced() const;

 private:
  struct File {
    std::filesystem::path path;
    dev_t device;
    ino_t number;
  };
  std::vector<File> files_;
};

}  // namespace tribodyn::server
