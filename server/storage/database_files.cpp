#include "server/storage/database_files.h"

#include <sys/stat.h>

#include <cerrno>
#include <map>
#include <system_error>

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

}  // namespace

void require_usable_path(const fs::path& database) {
  std::error_code unknown;  // opening the database reports an unreachable path
  const fs::file_status status = fs::status(database, unknown);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw StoreError(StoreError::Kind::kCannotOpen,
                     "database " + database.string() + " is not a regular file");
  }
  std::error_code missing;
  if (fs::file_size(database, missing) > 0 && !missing) return;
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

std::string DatabaseFiles::misplaced() const {
  for (const File& file : files_) {
    struct stat found {};
    const bool is_there = stat(file.path.c_str(), &found) == 0;
    if (is_there && found.st_dev == file.device && found.st_ino == file.number) continue;
    return file.path.string() + " was " + (is_there ? "replaced" : "deleted or renamed") +
           " while this server has it open; nothing is written until the file is back";
  }
  return {};
}

}  // namespace tribodyn::server
