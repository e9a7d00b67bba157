#include "server/storage/store.h"

#include <SQLiteCpp/Transaction.h>
#include <spdlog/spdlog.h>
#include <sqlite3.h>

#include <exception>

#include "server/storage/database_check.h"
#include "server/storage/durable_files.h"
#include "server/storage/resource_rows.h"
#include "server/storage/store_access.h"
#include "server/storage/translate_error.h"

namespace tribodyn::server {
namespace {

constexpr int kReaderConnections = 8;

std::filesystem::path usable_path(const std::filesystem::path& database) {
  std::filesystem::path path = canonical_path(database);
  require_usable_path(path);
  return path;
}

StoreError limits_over(const CallLimits& limits) {
  return limits.is_cancelled()
             ? StoreError(StoreError::Kind::kCancelled, "the caller gave up")
             : StoreError(StoreError::Kind::kDeadline, "the caller's deadline has passed");
}

void check(const CallLimits& limits) {
  if (limits.are_over()) throw limits_over(limits);
}

StoreError translate(const SQLite::Exception& error, const std::filesystem::path& path,
                     const CallLimits& limits) {
  return error.getErrorCode() == SQLITE_INTERRUPT ? limits_over(limits)
                                                  : translate_error(error, path);
}

Connection open_writer(const std::filesystem::path& path) try {
  configure_sqlite();
  return {path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyTimeoutMilliseconds};
} catch (const SQLite::Exception& error) {
  throw translate_error(error, path);
}

/// Thrown inside an action to roll back its change.
struct RollBack {};

/// Notes a change at its end, also after a failure: what failed may be on disk nevertheless.
class NotedChange {
 public:
  explicit NotedChange(RecentEvents& events) : events_(events) {}
  ~NotedChange() { events_.note_change(); }
  NotedChange(const NotedChange&) = delete;
  NotedChange& operator=(const NotedChange&) = delete;

 private:
  RecentEvents& events_;
};

}  // namespace

void Store::require_place() const {
  const std::string misplaced = this->misplaced();
  if (!misplaced.empty()) throw StoreError(StoreError::Kind::kMisplaced, misplaced);
}

/// Checks the files before the action, so that nothing is written in vain, and after it, so that no
/// change is acknowledged whose file has lost its name meanwhile.
void Store::run_write(const CallLimits& limits, const GroupCommit::Action& action) {
  {
    const std::lock_guard lock(writer_mutex_);
    check(limits);
    require_place();
    const NotedChange noted(recent_events_);
    try {
      const Connection::Under under(writer_, limits);
      action(writer_);
      require_place();
    } catch (const SQLite::Exception& error) {
      throw translate(error, path_, limits);
    }
  }
  observers_.tell();  // without the lock
}

void Store::write_together(const CallLimits& limits, const GroupCommit::Action& action) {
  check(limits);
  require_place();
  try {
    const auto commit = [&] {
      const NotedChange noted(recent_events_);
      group_commit_.run(action, limits);
    };
    commit();
    require_place();
    observers_.tell();
  } catch (const RollBack&) {
    return;
  } catch (const SQLite::Exception& error) {
    throw translate(error, path_, limits);
  }
}

std::optional<StoredEvent> Store::change_simulation(
    const CallLimits& limits,
    const std::function<std::optional<StoredEvent>(Connection&)>& change) {
  std::optional<StoredEvent> event;
  write_together(limits, [&](Connection& db) {
    event = change(db);
    if (!event) throw RollBack();
  });
  return event;
}

void Store::run_read(const CallLimits& limits, const GroupCommit::Action& action) {
  check(limits);
  try {
    ReaderPool::Loan loan = readers_.borrow(limits);
    if (!loan) throw limits_over(limits);
    const Connection::Under under(*loan, limits);
    action(*loan);
  } catch (const SQLite::Exception& error) {
    throw translate(error, path_, limits);
  }
}

Store::Store(const std::filesystem::path& database, const SchemaSteps& steps,
             std::chrono::milliseconds lock_wait)
    : path_(usable_path(database)),
      lock_(path_, lock_wait),
      writer_(open_writer(path_)),
      group_commit_(writer_, writer_mutex_) {
  open_schema(steps);
  writer_.heed_limits();
  try {
    // The writer keeps its statement journal (old pages, a few hundred KiB) in memory, so that it
    // opens no file later.
    writer_.exec("PRAGMA temp_store = MEMORY");
    readers_.open(path_, kReaderConnections);
    checkpointer_.emplace(path_, writer_);
    lock_.lock_new_file();
    files_.emplace(path_);
    lock_.remember(files_->record());
  } catch (const SQLite::Exception& error) {
    throw translate_error(error, path_);
  }
}

Store::~Store() {
  // With the connections still open: SQLite leaves the log alone when it closes a database that is
  // not in its place.
  try {
    const std::filesystem::path log = files_ ? files_->set_log_aside() : std::filesystem::path();
    if (log.empty()) return;
    spdlog::critical(
        "another file took the place of database {}; the write-ahead log of the former database, "
        "with its latest changes, is kept as {}: if the former database has another name by now, "
        "rename the log to that name followed by -wal before anything opens that file; else the "
        "log is of no use",
        path_.string(), log.string());
  } catch (const std::exception& error) {
    spdlog::critical("{}", error.what());
  }
}

void Store::open_schema(const SchemaSteps& steps) {
  run_write({}, [&](Connection& db) {
    require_servable(db, path_, steps);
    const int version = db.execAndGet("PRAGMA user_version").getInt();
    if (sqlite3_db_readonly(db.getHandle(), "main") == 1) {
      throw StoreError(StoreError::Kind::kReadOnly,
                       "database " + path_.string() + " cannot be written: it is read-only");
    }
    // SQLite reports some errors only by another mode.
    if (db.execAndGet("PRAGMA journal_mode = WAL").getString() != "wal") {
      throw StoreError(StoreError::Kind::kFailed,
                       "database " + path_.string() + ": cannot create its write-ahead log");
    }
    db.exec("PRAGMA synchronous = FULL");
    db.exec("PRAGMA foreign_keys = ON");
    if (version < static_cast<int>(steps.size())) {
      if (version > 0) migration_backup_ = backup_before_migration(path_, version);
      migrate(db, version, steps);
    }
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    const int renewed = add_missing_properties(db);
    transaction.commit();
    if (renewed > 0) spdlog::info("lists can filter {} resources by newer fields", renewed);
    SQLite::Statement projects(db, "SELECT name FROM projects");
    const std::lock_guard lock(projects_mutex_);
    while (projects.executeStep()) projects_.insert(projects.getColumn(0).getString());
  });
}

void Store::add_project(const std::string& project, const std::vector<NewResource>& resources,
                        Microseconds now) {
  run_write({}, [&](Connection& db) {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    execute(db, "INSERT INTO projects (name) VALUES (?) ON CONFLICT DO NOTHING", project);
    for (const NewResource& each : resources) {
      const std::string name = full_name(project, each.name);
      if (!is_taken(db, name)) insert_resource(db, {name, each.body}, now);
    }
    transaction.commit();
  });
  const std::lock_guard lock(projects_mutex_);
  projects_.insert(project);
}

bool Store::has_project(const std::string& project) const {
  const std::lock_guard lock(projects_mutex_);
  return projects_.contains(project);
}

Removed Store::remove_oldest(Microseconds ended_by, int limit) {
  return write({}, [&](Connection& db) {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    const Removed removed = server::remove_oldest(db, ended_by, limit);
    transaction.commit();
    return removed;
  });
}

std::int64_t Store::used_bytes() {
  return read({}, [](Connection& db) { return server::used_bytes(db); });
}

std::optional<Microseconds> Store::latest_creation() {
  return read({}, [](Connection& db) -> std::optional<Microseconds> {
    Prepared query(db, "SELECT create_time FROM simulations ORDER BY id DESC LIMIT 1");
    if (!query.executeStep()) return std::nullopt;
    return query.getColumn(0).getInt64();
  });
}

std::int64_t Store::removable_bytes() {
  return read({}, [](Connection& db) { return server::removable_bytes(db); });
}

std::int64_t Store::result_bytes(const std::string& project, const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared sum(db,
                 "SELECT (SELECT coalesce(sum(stored_bytes), 0) FROM results WHERE project = ?1) + "
                 "(SELECT coalesce(sum(stored_bytes), 0) FROM campaigns WHERE project = ?1)",
                 project);
    return sum.value().getInt64();
  });
}

double Store::unfinished_seconds(const std::string& project, const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared sum(db,
                 "SELECT (SELECT coalesce(sum(cost_seconds), 0) FROM simulations "
                 "WHERE project = ?1 AND state IN (1, 2)) + "
                 "(SELECT coalesce(sum(cost_seconds * (1 - 1.0 * points_done / "
                 "(candidates * conditions))), 0) FROM campaigns INDEXED BY running_campaigns "
                 "WHERE project = ?1 AND state = 1)",
                 project);
    return sum.value().getDouble();
  });
}

}  // namespace tribodyn::server
