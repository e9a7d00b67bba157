#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <vector>

namespace tribodyn::crash {

/// Replaces SQLite's default file system while the object exists: the real one with faults on
/// demand. It records which writes were synced, so that a loss of power can undo the others. Only
/// databases and write-ahead logs have faults. Safe for concurrent access. Create and destroy it
/// while no database is open.
class FaultyVfs {
 public:
  enum class Operation { kOpen, kWrite, kSync, kRead };
  static constexpr int kOperations = 4;

  FaultyVfs();
  ~FaultyVfs();
  FaultyVfs(const FaultyVfs&) = delete;
  FaultyVfs& operator=(const FaultyVfs&) = delete;

  /// Makes the n-th operation of this kind from now on fail, and if `lasting` all later ones.
  void fail(Operation operation, int n, bool lasting);
  /// Makes every operation but reads fail from the n-th one on, reads not counted: the power is
  /// off.
  void lose_power_at(int n);
  /// Allows `bytes` bytes of writes from now on; then the disk is full.
  void limit_space(std::int64_t bytes);
  /// Makes every later sync report success and do nothing.
  void ignore_syncs();
  /// Calls `action` after each sync that succeeds, until recover().
  void after_sync(std::function<void()> action);
  /// Ends all faults.
  void recover();

  /// Returns the number of operations since the last of the calls above.
  int count(Operation operation) const;
  /// As above, of all kinds but reads.
  int count() const;
  std::int64_t written_bytes() const;

  /// Leaves on disk what a loss of power leaves: every synced write, and of the others some, in
  /// whole or in part, in 512-byte sectors. Requires that all databases are closed.
  void drop_unsynced(std::mt19937_64& random);

 private:
  friend struct FaultyFile;

  /// A write, or a truncation if there are no bytes.
  struct Change {
    std::int64_t offset = 0;
    std::vector<char> bytes;
  };
  struct Contents {
    std::vector<char> durable;
    std::vector<Change> unsynced;
  };

  static int open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags,
                  int* out_flags);
  static int remove(sqlite3_vfs* vfs, const char* name, int sync_folder);

  /// Returns SQLITE_OK, or `error` if the operation must fail.
  int attempt(Operation operation, int error, std::int64_t bytes = 0);
  int operations_without_reads() const;  ///< requires mutex_
  std::function<void()> sync_action() const;
  void begin_plan();
  void note_open(const std::string& path);
  void note_change(const std::string& path, Change change);
  void note_sync(const std::string& path);

  sqlite3_vfs* const base_;
  sqlite3_vfs vfs_{};
  sqlite3_io_methods methods_{};
  mutable std::mutex mutex_;
  std::map<std::string, Contents> files_;                          // guarded by mutex_
  int counts_[kOperations] = {};                                   // guarded by mutex_
  std::int64_t written_ = 0;                                       // guarded by mutex_
  int fail_at_[kOperations] = {};                                  // guarded by mutex_; 0: never
  bool ignores_syncs_ = false;                                     // guarded by mutex_
  bool lasting_ = false;                                           // guarded by mutex_
  int power_off_at_ = 0;                                           // guarded by mutex_; 0: never
  std::function<void()> after_sync_;                               // guarded by mutex_
  std::int64_t space_ = std::numeric_limits<std::int64_t>::max();  // guarded by mutex_
};

}  // namespace tribodyn::crash
