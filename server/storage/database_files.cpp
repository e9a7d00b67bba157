#include "server/storage/database_files.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <map>
#include <system_error>

#include "server/storage/database_lock.h"
#include "server/storage/durable_files.h"
#include "server/storage/store_error.h"

namespace tribodyn::server {
namespace {

namespace fs = std::filesystem;

/// Returns advice about a file beside a missing database, or an empty string if the file does not
/// matter.
std::string advice_on(const std::string& file, const std::string& database) {
  if (file.starts_with(database + ".replaced")) {
    return "a former database is kept as " + file + ": rename that file to " + database +
           ", or restore a backup";
  }
  if (file.starts_with(database + ".new-")) {
    return "an interrupted backup or restore left " + file + ": restore the backup again";
  }
  if (file == database + "-wal" && fs::file_size(file) > 0) {
    return "its write-ahead log " + file +
           " still exists: move the database file back, or restore a backup";
  }
  return {};
}

/// Returns the advice for each file, sorted by name.
std::map<std::string, std::string> leftovers_of(const fs::path& database) {
  std::map<std::string, std::string> out;
  const fs::path parent = database.parent_path();
  std::error_code ignored;  // opening the database reports an unreadable folder
  for (const auto& entry : fs::directory_iterator(parent.empty() ? "." : parent, ignored)) {
    const fs::path file = parent / entry.path().filename();
    std::string advice = advice_on(file.string(), database.string());
    if (!advice.empty()) out[file.string()] = std::move(advice);
  }
  return out;
}

/// Inode number and time of birth (0 where the file system keeps none), which tell a file from
/// another one that got its inode number later. Empty if there is no such file.
std::string identity_of(const fs::path& file) {
  struct statx found {};
  if (statx(AT_FDCWD, file.c_str(), 0, STATX_INO | STATX_BTIME, &found) != 0) return {};
  std::string out = std::to_string(found.stx_ino) + "/";
  if ((found.stx_mask & STATX_BTIME) == 0) return out + "0";
  return out + std::to_string(found.stx_btime.tv_sec) + "." +
         std::to_string(found.stx_btime.tv_nsec);
}

constexpr char kDatabaseWord[] = "database ", kLogWord[] = " log ";

std::string record_of(const std::string& database, const std::string& log) {
  return kDatabaseWord + database + kLogWord + log;
}

}  // namespace

void require_own_log(const fs::path& database) {
  const fs::path log = database.string() + "-wal";
  std::error_code missing;
  if (fs::file_size(log, missing) == 0 || missing) return;
  const std::string record = DatabaseLock::remembered(database);
  const std::string now = record_of(identity_of(database), identity_of(log));
  const bool is_same_log =
      record.starts_with(kDatabaseWord) && record.ends_with(kLogWord + identity_of(log));
  if (!is_same_log || record == now || !fs::exists(database)) return;
  throw StoreError(StoreError::Kind::kCannotOpen,
                   "database " + database.string() + " is another file than the one that " +
                       log.string() + " belongs to, and that log would destroy it: move " +
                       log.string() +
                       " elsewhere (if the former database is kept under another name, beside it, "
                       "as that name followed by -wal). Only if the file is a copy of the former "
                       "database as its server left it, remove " +
                       database.string() + ".lock instead");
}

void require_usable_path(const fs::path& database) {
  std::error_code unknown;  // opening the database reports an unreachable path
  const fs::file_status status = fs::status(database, unknown);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw StoreError(StoreError::Kind::kCannotOpen,
                     "database " + database.string() + " is not a regular file");
  }
  std::error_code missing;
  if (fs::file_size(database, missing) > 0 && !missing) return require_own_log(database);
  const std::map<std::string, std::string> leftovers = leftovers_of(database);
  if (leftovers.empty()) return;
  const auto& [file, advice] = *leftovers.begin();
  throw StoreError(StoreError::Kind::kCannotOpen,
                   "there is no database " + database.string() + ", but " + advice +
                       "; to start with an empty database, move " + file + " elsewhere");
}

DatabaseFiles::DatabaseFiles(const fs::path& database) {
  for (const char* suffix : {"", "-wal"}) {
    struct stat found {};
    const fs::path path = database.string() + suffix;
    if (stat(path.c_str(), &found) != 0) {
      throw StoreError(StoreError::Kind::kFailed, "database " + database.string() +
                                                      ": cannot find " + path.string() + ": " +
                                                      std::generic_category().message(errno));
    }
    files_.push_back({path, found.st_dev, found.st_ino});
  }
}

DatabaseFiles::FileAtPath DatabaseFiles::file_at(const File& file) {
  struct stat found {};
  if (stat(file.path.c_str(), &found) != 0) return FileAtPath::kEmpty;
  const bool is_held = found.st_dev == file.device && found.st_ino == file.number;
  return is_held ? FileAtPath::kHeld : FileAtPath::kOfAnother;
}

std::string DatabaseFiles::misplaced() const {
  for (const File& file : files_) {
    const FileAtPath found = file_at(file);
    if (found == FileAtPath::kHeld) continue;
    return file.path.string() + " was " +
           (found == FileAtPath::kOfAnother ? "replaced" : "deleted or renamed") +
           " while this server has it open; nothing is written until the file is back";
  }
  return {};
}

std::string DatabaseFiles::record() const {
  return record_of(identity_of(files_[0].path), identity_of(files_[1].path));
}

fs::path DatabaseFiles::set_log_aside() const {
  const File& log = files_[1];
  if (file_at(files_[0]) != FileAtPath::kOfAnother || file_at(log) != FileAtPath::kHeld) return {};
  std::error_code unknown;
  if (fs::file_size(log.path, unknown) == 0) return {};
  std::string name = log.path.string() + ".left-XXXXXX";
  const int descriptor = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor >= 0) close(descriptor);
  if (descriptor < 0 || rename(log.path.c_str(), name.c_str()) != 0) {
    throw StoreError(StoreError::Kind::kFailed, "cannot rename " + log.path.string() + " to " +
                                                    name + ": " +
                                                    std::generic_category().message(errno));
  }
  sync_folder_of(log.path);
  return name;
}

}  // namespace tribodyn::server
