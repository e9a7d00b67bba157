#include "server/storage/maintenance.h"

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/Statement.h>
#include <sqlite3.h>

#include <algorithm>
#include <new>

#include "server/storage/connections.h"
#include "server/storage/database_check.h"
#include "server/storage/database_files.h"
#include "server/storage/database_lock.h"
#include "server/storage/durable_files.h"
#include "server/storage/store_error.h"
#include "server/storage/translate_error.h"

namespace tribodyn::server {
namespace {

namespace fs = std::filesystem;

constexpr int kAllPages = -1;
// Suffixes of copies of a database; a number may follow.
constexpr char kBeforeMigration[] = ".schema-";
constexpr char kFormer[] = ".replaced";

/// Runs an action on the database `path` and converts its exceptions to StoreError.
template <class Action>
auto translated(const fs::path& path, const Action& action) {
  try {
    return action();
  } catch (const SQLite::Exception& error) {
    throw translate_error(error, path);
  } catch (const fs::filesystem_error& error) {
    throw StoreError(StoreError::Kind::kFailed, error.what());
  } catch (const std::bad_alloc&) {
    throw StoreError(StoreError::Kind::kFailed, "not enough memory to read " + path.string());
  }
}

/// Returns the files whose path begins with that of the database and `suffix`, sorted.
std::vector<fs::path> files_beside(const fs::path& database, const std::string& suffix) {
  return translated(database, [&] {
    std::vector<fs::path> out;
    const fs::path parent = database.parent_path();
    for (const auto& entry : fs::directory_iterator(parent.empty() ? "." : parent)) {
      if (entry.path().filename().string().starts_with(database.filename().string() + suffix)) {
        out.push_back(entry.path());
      }
    }
    std::sort(out.begin(), out.end());
    return out;
  });
}

Connection open_existing(const fs::path& path, int flags) {
  if (!fs::exists(path)) {
    throw StoreError(StoreError::Kind::kCannotOpen, "there is no database " + path.string());
  }
  return {path.string(), flags, kBusyTimeoutMilliseconds};
}

StoreError in_use(const fs::path& database) {
  return {StoreError::Kind::kInUse,
          "database " + database.string() + " is in use by another program"};
}

/// Copies a snapshot of a database into an empty file.
void copy_database(const fs::path& from, const fs::path& to) {
  Connection source = open_existing(from, SQLite::OPEN_READONLY);
  // Without a read transaction SQLite restarts the copy whenever another connection commits, and
  // never finishes it under steady writes.
  source.exec("BEGIN");
  check_identity(source, from);  // the first read begins the transaction
  translated(to, [&] {
    Connection target = open_existing(to, SQLite::OPEN_READWRITE);
    if (SQLite::Backup(target, source).executeStep(kAllPages) != SQLITE_DONE) throw in_use(from);
  });
}

/// Copies a snapshot of a database into an empty file. Returns the problems of the copy.
Problems copy_and_check(const fs::path& from, const fs::path& to) {
  copy_database(from, to);
  // Writable, so that closing it removes the write-ahead log that opening it creates.
  Connection copied = open_existing(to, SQLite::OPEN_READWRITE);
  return problems_of(copied, to);
}

/// Moves the contents of a database's write-ahead log into the database file. Returns false if the
/// file is not a SQLite database or is damaged.
bool fold_log(const fs::path& database) {
  if (fs::file_size(database) == 0) return false;
  try {
    Connection db = open_existing(database, SQLite::OPEN_READWRITE);
    db.execAndGet("SELECT count(*) FROM sqlite_master");
    SQLite::Statement checkpoint(db, "PRAGMA wal_checkpoint(TRUNCATE)");
    checkpoint.executeStep();
    if (checkpoint.getColumn(0).getInt() == 0) return true;
    throw in_use(database);
  } catch (const SQLite::Exception& error) {
    const int code = error.getErrorCode();
    if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT) return false;
    throw translate_error(error, database);
  }
}

/// Gives the database a second name: the first of X.replaced, X.replaced.2, ... that neither a file
/// nor a log has. Returns that name.
fs::path kept_name(const fs::path& database) {
  for (int number = 1;; ++number) {
    fs::path name = database.string() + kFormer;
    if (number > 1) name += "." + std::to_string(number);
    if (fs::exists(name.string() + "-wal") || fs::exists(name.string() + "-journal")) continue;
    if (!fs::exists(database)) {
      if (!fs::exists(name)) return name;
    } else if (add_name(database, name) || fs::equivalent(database, name)) {
      return name;  // equivalent: a killed restore has already added the name
    }
  }
}

/// Prepares the replacement of the database: keeps the old one under a second name, and removes
/// every log that SQLite would apply to the new one. Returns the second name.
fs::path keep_old(const fs::path& database) {
  const bool is_folded = fs::exists(database) && fold_log(database);
  fs::path kept = kept_name(database);
  for (const char* suffix : {"-wal", "-journal"}) {
    const fs::path log = database.string() + suffix;
    if (!fs::exists(log)) continue;
    if (!is_folded) {
      fs::rename(log, kept.string() + suffix);
    } else if (fs::file_size(log) == 0) {
      fs::remove(log);
    } else {
      throw in_use(database);
    }
  }
  fs::remove(database.string() + "-shm");
  sync_folder_of(database);
  return kept;
}

/// Makes a copy readable from a medium that cannot be written: without a write-ahead log.
void leave_log_mode(const fs::path& copy) {
  Connection db = open_existing(copy, SQLite::OPEN_READWRITE);
  db.exec("PRAGMA journal_mode = DELETE");
}

}  // namespace

void backup_database(const fs::path& database, const fs::path& copy) {
  const StoreError is_there(StoreError::Kind::kFailed,
                            copy.string() + " exists; use the name of a new file");
  translated(database, [&] {
    if (fs::exists(copy)) throw is_there;
    require_own_log(canonical_path(database));
    UnfinishedFile unfinished(copy);
    const Problems problems = copy_and_check(database, unfinished.path());
    if (!problems.empty()) {
      throw StoreError(StoreError::Kind::kCorrupt,
                       database.string() + " is damaged, no backup was made: " + problems.front());
    }
    leave_log_mode(unfinished.path());
    if (!unfinished.publish_as_new()) throw is_there;
  });
}

fs::path backup_before_migration(const fs::path& database, int schema) {
  return translated(database, [&] {
    UnfinishedFile unfinished(database);
    copy_database(database, unfinished.path());
    for (int number = 1;; ++number) {
      fs::path name = database.string() + kBeforeMigration + std::to_string(schema);
      if (number > 1) name += "." + std::to_string(number);
      if (unfinished.publish_as(name)) return name;
    }
  });
}

std::vector<fs::path> migration_backups(const fs::path& database) {
  return files_beside(database, kBeforeMigration);
}

void remove_migration_backups(const fs::path& database) {
  translated(database, [&] {
    for (const fs::path& each : migration_backups(database)) fs::remove(each);
    sync_folder_of(database);
  });
}

std::vector<fs::path> former_databases(const fs::path& database) {
  return files_beside(database, kFormer);
}

std::optional<fs::path> restore_database(const fs::path& copy, const fs::path& database) {
  const fs::path target = canonical_path(database);
  return translated(copy, [&]() -> std::optional<fs::path> {
    const bool is_first = !fs::exists(target);
    if (!is_first && fs::exists(copy) && fs::equivalent(copy, target)) {
      throw StoreError(StoreError::Kind::kFailed, copy.string() + " is the database itself");
    }
    const DatabaseLock lock(target);
    require_own_log(target);
    UnfinishedFile unfinished(target);
    const Problems problems = copy_and_check(copy, unfinished.path());
    if (!problems.empty()) {
      throw StoreError(StoreError::Kind::kCorrupt,
                       copy.string() + " is damaged: " + problems.front());
    }
    fs::path kept = translated(target, [&] { return keep_old(target); });
    unfinished.publish_over();
    if (is_first) return std::nullopt;
    return kept;
  });
}

std::vector<std::string> check_database(const fs::path& database, const HashInputs& hash_inputs,
                                        const SchemaSteps& steps) {
  return translated(database, [&] {
    require_usable_path(canonical_path(database));
    Connection db = open_existing(database, SQLite::OPEN_READONLY);
    return problems_of(db, database, hash_inputs, steps);
  });
}

}  // namespace tribodyn::server
