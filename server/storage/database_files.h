#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tribodyn::server {

/// Throws StoreError kCannotOpen if a server must not open or create a database at the path: it is
/// not a file, or it does not exist although a file beside it shows that a database existed (a
/// write-ahead log, a database that a restore kept, the unfinished copy of a restore). A new
/// database would hide the loss. Throws as require_own_log() does, too.
void require_usable_path(const std::filesystem::path& database);

/// Throws StoreError kCannotOpen if the write-ahead log beside a database is known to belong to
/// another database file, e.g. because the file was replaced after its server had been killed:
/// SQLite would write the log into whatever file is there, and so destroy it. The last server
/// recorded inode numbers and birth times of both files in "<database>.lock"; a log that is still
/// the recorded one, beside a database that is not, is refused. Not recognised: a database that was
/// overwritten in place; a file replaced where the record is missing (the lock file was removed, or
/// the power failed in the first moments of the server); and, on a file system without birth times,
/// a file that got the inode number of the former database after that had been removed.
void require_own_log(const std::filesystem::path& database);

/// The database file and its write-ahead log at the time when a server opened them. Safe for
/// concurrent access.
class DatabaseFiles {
 public:
  /// Requires that both files exist. Throws StoreError kFailed.
  explicit DatabaseFiles(const std::filesystem::path& database);

  /// Returns a sentence for the operator if one of the paths now has another file or none: writes
  /// to the open files would be lost. Returns an empty string otherwise.
  std::string misplaced() const;

  /// What require_own_log() compares, for DatabaseLock::remember().
  std::string record() const;

  /// Renames the write-ahead log that the server opened to "<database>-wal.left-XXXXXX" if the path
  /// of the database holds another file by now, to which SQLite would apply the log at the next
  /// start. Returns the new name; empty, and changes nothing, if the database is in its place or
  /// nothing is there, or the log is empty, gone or not the one that the server opened. No
  /// connection may write any more. Throws StoreError kFailed.
  std::filesystem::path set_log_aside() const;

 private:
  struct File {
    std::filesystem::path path;
    dev_t device;
    ino_t number;
  };
  enum class FileAtPath { kHeld, kEmpty, kOfAnother };
  static FileAtPath file_at(const File& file);

  std::vector<File> files_;  // the database, its write-ahead log
};

}  // namespace tribodyn::server
