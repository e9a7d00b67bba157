#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tribodyn::server {

/// Throws StoreError kCannotOpen if a server must not open or make a database at the path: it holds
/// something else than a file, or no database although a file beside it shows that there was one (a
/// write-ahead log, a database that a restore kept, the unfinished copy of a restore). A new
/// database in that place would hide the loss.
void require_usable_path(const std::filesystem::path& database);

/// The database file and its write-ahead log as a server opened them. Safe for concurrent access.
class DatabaseFiles {
 public:
  /// Requires that both files exist. Throws StoreError kFailed.
  explicit DatabaseFiles(const std::filesystem::path& database);

  /// A sentence for the person who runs the server if one of the paths holds another file by now,
  /// or none: whatever is written to the open files then would be lost. Empty otherwise.
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
