#pragma once

#include <filesystem>

namespace tribodyn::server {

/// Keeps a second server away from a database by an flock on "<database>.lock" and one on the
/// database file itself, which holds where the lock file was removed or the file has a second name
/// (a hard link). The kernel releases both when the process ends, however it ends. SQLite's own
/// locks cannot do this: in WAL mode two servers would share the file and run every job twice. An
/// flock is independent of them on local file systems.
///
/// Requires that no connection of this process to the database is open when the object is
/// destroyed: closing any descriptor of a file drops SQLite's locks on it. Not safe for concurrent
/// access.
class DatabaseLock {
 public:
  /// Locks the lock file and, if it exists, the database file. Throws StoreError kInUse, which
  /// names the other process where that is known, or kCannotOpen.
  explicit DatabaseLock(const std::filesystem::path& database);
  ~DatabaseLock();
  DatabaseLock(const DatabaseLock&) = delete;
  DatabaseLock& operator=(const DatabaseLock&) = delete;

  /// Locks a database file that did not exist before. Throws as the constructor does.
  void lock_new_file();

 private:
  /// Opens and locks; the descriptor.
  int lock(const std::filesystem::path& file, int flags) const;

  const std::filesystem::path database_;
  int lock_file_ = -1;
  int database_file_ = -1;
};

}  // namespace tribodyn::server
