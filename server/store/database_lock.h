#pragma once

#include <filesystem>

namespace tribodyn::server {

/// Keeps a second server away from a database: an flock on "<database>.lock", held for as long as
/// the object lives and dropped by the kernel when the process dies, however it dies. SQLite's own
/// locks cannot say this: in WAL mode two servers would share the file and run every job twice.
/// Not safe for concurrent access; made and destroyed by one thread.
class DatabaseLock {
 public:
  /// Throws StoreError kInUse, naming the other process, or kCannotOpen.
  explicit DatabaseLock(const std::filesystem::path& database);
  ~DatabaseLock();
  DatabaseLock(const DatabaseLock&) = delete;
  DatabaseLock& operator=(const DatabaseLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace tribodyn::server
