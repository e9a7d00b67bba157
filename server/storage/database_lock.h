#pragma once

#include <chrono>
#include <filesystem>
#include <string>

namespace tribodyn::server {

/// Prevents a second server from using a database by an flock on "<database>.lock" and one on the
/// database file itself. The second one is needed if the lock file was removed or the database has
/// a second name (a hard link). The kernel releases both when the process ends, however it ends.
/// SQLite's own locks do not suffice: in WAL mode two servers would share the file and run every
/// job twice. On local file systems an flock is independent of them.
///
/// Requires that no connection of this process to the database is open when the object is
/// destroyed: closing any descriptor of a file releases SQLite's locks on it. Not safe for
/// concurrent access.
class DatabaseLock {
 public:
  /// Locks the lock file and, if it exists, the database file. Throws StoreError kInUse, which
  /// names the other process if it is known, if another one still has a lock after `wait`; or
  /// kCannotOpen.
  explicit DatabaseLock(const std::filesystem::path& database, std::chrono::milliseconds wait = {});
  ~DatabaseLock();
  DatabaseLock(const DatabaseLock&) = delete;
  DatabaseLock& operator=(const DatabaseLock&) = delete;

  /// Locks a database file that the constructor did not find. Throws like the constructor.
  void lock_new_file();

  /// Keeps a line of text in the lock file, also when the process has ended, in place of the former
  /// one. Best effort: a failure is ignored.
  void remember(const std::string& line);
  /// The line that a process remembered for a database last; empty if there is none.
  static std::string remembered(const std::filesystem::path& database);

 private:
  /// Opens and locks a file. Returns its descriptor.
  int lock(const std::filesystem::path& file, int flags) const;

  const std::filesystem::path database_;
  const std::chrono::milliseconds wait_;
  int lock_file_ = -1;
  int database_file_ = -1;
};

}  // namespace tribodyn::server
