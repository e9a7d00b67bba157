#include "server/store/store.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <sqlite3.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "server/store/deadline.h"
#include "server/store/resource_queries.h"
#include "server/store/resource_rows.h"
#include "server/store/schema.h"
#include "server/store/translate_error.h"

static_assert(std::endian::native == std::endian::little, "history columns are little-endian");

namespace tribodyn::server {
namespace {

constexpr int kReaderConnections = 8;

/// One path for one file, so that two spellings of it meet in one lock.
std::filesystem::path one_path(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::path found = std::filesystem::weakly_canonical(path, ignored);
  return found.empty() ? path : found;
}

void check_deadline(const std::filesystem::path& path) {
  if (DeadlineScope::has_passed()) {
    throw StoreError(StoreError::Kind::kDeadline,
                     "database " + path.string() + ": the deadline has passed");
  }
}

SQLite::Database open_writer(const std::filesystem::path& path) try {
  return {path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyTimeoutMilliseconds};
} catch (const SQLite::Exception& error) {
  throw translate_error(error, path);
}

StoredSimulation row(const SQLite::Statement& query) {
  StoredSimulation out;
  out.id = query.getColumn(0).getInt64();
  out.state = static_cast<StoredState>(query.getColumn(1).getInt());
  out.create_time = query.getColumn(2).getInt64();
  if (!query.getColumn(3).isNull()) out.start_time = query.getColumn(3).getInt64();
  if (!query.getColumn(4).isNull()) out.end_time = query.getColumn(4).getInt64();
  out.request = query.getColumn(5).getString();
  out.input_hash = query.getColumn(6).getString();
  out.error_reason = query.getColumn(7).getString();
  out.error_message = query.getColumn(8).getString();
  out.lubricant_revision = query.getColumn(9).getString();
  out.gear_set_revision = query.getColumn(10).getString();
  out.surface_revision = query.getColumn(11).getString();
  out.vehicle_revision = query.getColumn(12).getString();
  return out;
}

constexpr char kSimulationColumns[] =
    "SELECT id, state, create_time, start_time, end_time, request, input_hash, error_reason, "
    "error_message, "
    "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = lubricant), "
    "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = gear_set), "
    "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = surface), "
    "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = vehicle) "
    "FROM simulations ";

/// Row of "lubricants/1@2" in revisions.
std::int64_t revision_row(SQLite::Database& db, const std::string& name) {
  SQLite::Statement query(
      db,
      "SELECT revision_id FROM revision_names WHERE name || '@' || revision = ?1 AND "
      "name = substr(?1, 1, instr(?1, '@') - 1)");
  query.bind(1, name);
  if (!query.executeStep()) throw SQLite::Exception("no such revision");
  return query.getColumn(0).getInt64();
}

/// Incremental reading of one blob.
class BlobReader {
 public:
  BlobReader(SQLite::Database& database, std::int64_t row_id) {
    if (sqlite3_blob_open(database.getHandle(), "main", "history", "data", row_id, 0, &blob_) !=
        SQLITE_OK) {
      const SQLite::Exception error(database.getHandle());
      sqlite3_blob_close(blob_);
      throw error;
    }
  }
  ~BlobReader() { sqlite3_blob_close(blob_); }
  BlobReader(const BlobReader&) = delete;
  BlobReader& operator=(const BlobReader&) = delete;

  std::vector<double> read(std::int64_t start, std::int64_t count) {
    std::vector<double> values(static_cast<std::size_t>(count));
    const int status = sqlite3_blob_read(blob_, values.data(), static_cast<int>(count * 8),
                                         static_cast<int>(start * 8));
    if (status != SQLITE_OK) throw SQLite::Exception("cannot read a history column", status);
    return values;
  }

 private:
  sqlite3_blob* blob_ = nullptr;
};

}  // namespace

template <class Action>
auto Store::write(const Action& action) {
  const std::lock_guard lock(writer_mutex_);
  check_deadline(path_);
  try {
    return action(writer_);
  } catch (const SQLite::Exception& error) {
    throw translate_error(error, path_);
  }
}

template <class Action>
auto Store::read(const Action& action) {
  check_deadline(path_);
  try {
    ReaderPool::Loan loan = readers_.borrow();
    return action(*loan);
  } catch (const SQLite::Exception& error) {
    throw translate_error(error, path_);
  }
}

Store::Store(const std::filesystem::path& database)
    : path_(one_path(database)),
      lock_(path_),
      writer_(open_writer(path_)),
      readers_(path_, kReaderConnections) {
  open_schema();
  heed_deadlines(writer_);
}

void Store::open_schema() {
  write([this](SQLite::Database& db) {
    const auto pragma = [&db](const char* name) {
      return db.execAndGet(std::string("PRAGMA ") + name).getInt();
    };
    const int version = pragma("user_version");
    const bool ours = pragma("application_id") == kApplicationId;
    const bool empty = db.execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0;
    if (!empty && !ours) {
      throw StoreError(StoreError::Kind::kForeign,
                       "database " + path_.string() + " belongs to another program");
    }
    if (version > kSchemaVersion) {
      throw StoreError(StoreError::Kind::kNewerSchema,
                       "database " + path_.string() + " has schema " + std::to_string(version) +
                           ", written by a newer tribodynd; this one knows schemas up to " +
                           std::to_string(kSchemaVersion));
    }
    if (sqlite3_db_readonly(db.getHandle(), "main") == 1) {
      throw StoreError(StoreError::Kind::kReadOnly,
                       "database " + path_.string() + " cannot be written: it is read-only");
    }
    db.execAndGet("PRAGMA journal_mode = WAL");
    db.exec("PRAGMA synchronous = FULL");
    db.exec("PRAGMA foreign_keys = ON");
    if (version < kSchemaVersion) migrate(db, version, system_time());
  });
}

void Store::add_resources(const std::vector<NewResource>& resources, Microseconds now) {
  write([&](SQLite::Database& db) {
    SQLite::Transaction transaction(db);
    for (const NewResource& each : resources) {
      if (!is_taken(db, each.name)) insert_resource(db, each, now);
    }
    transaction.commit();
  });
}

std::optional<StoredResource> Store::resource(const std::string& name) {
  return read([&](SQLite::Database& db) -> std::optional<StoredResource> {
    SQLite::Statement query(
        db, std::string(kResourceColumns) +
                "FROM resources r JOIN revisions v ON v.id = r.present WHERE r.name = ?");
    query.bind(1, name);
    if (!query.executeStep()) return std::nullopt;
    return stored_resource(query);
  });
}

std::optional<StoredResource> Store::revision(const std::string& name, int revision) {
  return read([&](SQLite::Database& db) -> std::optional<StoredResource> {
    SQLite::Statement query(db, std::string(kResourceColumns) +
                                    "FROM resources r JOIN revisions v ON v.resource = r.id "
                                    "WHERE r.name = ? AND v.revision = ?");
    query.bind(1, name);
    query.bind(2, revision);
    if (!query.executeStep()) return std::nullopt;
    return stored_resource(query);
  });
}

Page<StoredResource> Store::resources(const ResourceQuery& query) {
  return read([&](SQLite::Database& db) { return query_resources(db, query); });
}

Page<StoredResource> Store::revisions(const std::string& name, int before, int limit,
                                      std::size_t byte_limit) {
  return read([&](SQLite::Database& db) {
    SQLite::Statement query(db, std::string(kResourceColumns) +
                                    "FROM resources r JOIN revisions v ON v.resource = r.id "
                                    "WHERE r.name = ? AND v.revision < ? "
                                    "ORDER BY v.revision DESC LIMIT ?");
    query.bind(1, name);
    query.bind(2, before == 0 ? std::numeric_limits<int>::max() : before);
    query.bind(3, limit + 1);
    return read_page<StoredResource>(query, limit, byte_limit, kBodyColumn, stored_resource);
  });
}

std::vector<std::string> Store::resource_names(const std::string& collection) {
  return read([&](SQLite::Database& db) {
    SQLite::Statement query(
        db,
        "SELECT name FROM resources WHERE collection = ? AND delete_time IS NULL ORDER BY name");
    query.bind(1, collection);
    std::vector<std::string> names;
    while (query.executeStep()) names.push_back(query.getColumn(0).getString());
    return names;
  });
}

std::optional<std::vector<StoredResource>> Store::write_resources(
    const std::vector<ResourceWrite>& writes, Microseconds now) {
  return write([&](SQLite::Database& db) -> std::optional<std::vector<StoredResource>> {
    SQLite::Transaction transaction(db);
    std::vector<StoredResource> written;
    written.reserve(writes.size());
    for (const auto& [resource, present] : writes) {
      if (present ? !is_unchanged(db, *present) : is_taken(db, resource.name)) return std::nullopt;
      written.push_back(present ? insert_revision(db, *present, resource.body, now)
                                : insert_resource(db, resource, now));
    }
    transaction.commit();
    return written;
  });
}

template <class Change>
bool Store::change(const StoredResource& present, const Change& change) {
  return write([&](SQLite::Database& db) {
    SQLite::Transaction transaction(db);
    if (!is_unchanged(db, present)) return false;
    change(db);
    transaction.commit();
    return true;
  });
}

bool Store::delete_resource(const StoredResource& present, Microseconds now) {
  return change(present, [&](SQLite::Database& db) {
    SQLite::Statement mark(db, "UPDATE resources SET delete_time = ? WHERE id = ?");
    mark.bind(1, now);
    mark.bind(2, present.id);
    mark.exec();
  });
}

bool Store::undelete_resource(const StoredResource& present) {
  return change(present, [&](SQLite::Database& db) {
    SQLite::Statement mark(db, "UPDATE resources SET delete_time = NULL WHERE id = ?");
    mark.bind(1, present.id);
    mark.exec();
  });
}

std::int64_t Store::add_simulation(const NewSimulation& simulation, Microseconds now) {
  return write([&](SQLite::Database& db) -> std::int64_t {
    SQLite::Statement insert(
        db,
        "INSERT INTO simulations (state, create_time, request, input_hash, lubricant, gear_set, "
        "surface, vehicle) VALUES (1, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(1, now);
    bind_blob(insert, 2, simulation.request);
    insert.bind(3, simulation.input_hash);
    int index = 3;
    for (const std::string* each : {&simulation.lubricant_revision, &simulation.gear_set_revision,
                                    &simulation.surface_revision, &simulation.vehicle_revision}) {
      ++index;
      if (!each->empty()) insert.bind(index, revision_row(db, *each));
    }
    insert.exec();
    return db.getLastInsertRowid();
  });
}

std::optional<StoredSimulation> Store::simulation(std::int64_t id) {
  return read([&](SQLite::Database& db) -> std::optional<StoredSimulation> {
    SQLite::Statement query(db, std::string(kSimulationColumns) + "WHERE id = ?");
    query.bind(1, id);
    if (!query.executeStep()) return std::nullopt;
    return row(query);
  });
}

Page<StoredSimulation> Store::simulations(std::int64_t before, int limit, std::size_t byte_limit) {
  return read([&](SQLite::Database& db) {
    SQLite::Statement query(
        db, std::string(kSimulationColumns) + "WHERE id < ? ORDER BY id DESC LIMIT ?");
    query.bind(1, before == 0 ? std::numeric_limits<std::int64_t>::max() : before);
    query.bind(2, limit + 1);
    return read_page<StoredSimulation>(query, limit, byte_limit, 5, row);
  });
}

bool Store::mark_running(std::int64_t id, Microseconds now) {
  return write([&](SQLite::Database& db) {
    SQLite::Statement update(
        db, "UPDATE simulations SET state = 2, start_time = ? WHERE id = ? AND state = 1");
    update.bind(1, now);
    update.bind(2, id);
    return update.exec() == 1;
  });
}

bool Store::mark_queued(std::int64_t id) {
  return write([&](SQLite::Database& db) {
    SQLite::Statement update(
        db, "UPDATE simulations SET state = 1, start_time = NULL WHERE id = ? AND state = 2");
    update.bind(1, id);
    return update.exec() == 1;
  });
}

bool Store::mark_cancelled(std::int64_t id, Microseconds now) {
  return write([&](SQLite::Database& db) {
    SQLite::Statement update(
        db, "UPDATE simulations SET state = 5, end_time = ? WHERE id = ? AND state IN (1, 2)");
    update.bind(1, now);
    update.bind(2, id);
    return update.exec() == 1;
  });
}

bool Store::mark_failed(std::int64_t id, Microseconds now, const std::string& reason,
                        const std::string& message) {
  return write([&](SQLite::Database& db) {
    SQLite::Statement update(db,
                             "UPDATE simulations SET state = 4, end_time = ?, error_reason = ?, "
                             "error_message = ? WHERE id = ? AND state IN (1, 2)");
    update.bind(1, now);
    update.bind(2, reason);
    update.bind(3, message);
    update.bind(4, id);
    return update.exec() == 1;
  });
}

bool Store::mark_succeeded(std::int64_t id, Microseconds now, const std::string& result,
                           const std::vector<StoredColumn>& history) {
  return write([&](SQLite::Database& db) {
    SQLite::Transaction transaction(db);
    SQLite::Statement update(
        db, "UPDATE simulations SET state = 3, end_time = ? WHERE id = ? AND state = 2");
    update.bind(1, now);
    update.bind(2, id);
    if (update.exec() != 1) return false;
    SQLite::Statement insert(db, "INSERT INTO results VALUES (?, ?)");
    insert.bind(1, id);
    bind_blob(insert, 2, result);
    insert.exec();
    SQLite::Statement column(
        db, "INSERT INTO history (simulation, position, name, data) VALUES (?, ?, ?, ?)");
    for (std::size_t i = 0; i < history.size(); ++i) {
      column.bind(1, id);
      column.bind(2, static_cast<std::int64_t>(i));
      column.bind(3, history[i].name);
      column.bindNoCopy(4, history[i].values.data(),
                        static_cast<int>(history[i].values.size() * sizeof(double)));
      column.exec();
      column.reset();
    }
    transaction.commit();
    return true;
  });
}

std::vector<std::int64_t> Store::requeue_unfinished() {
  return write([](SQLite::Database& db) {
    SQLite::Transaction transaction(db);
    db.exec("UPDATE simulations SET state = 1, start_time = NULL WHERE state = 2");
    SQLite::Statement query(db, "SELECT id FROM simulations WHERE state = 1 ORDER BY id");
    std::vector<std::int64_t> ids;
    while (query.executeStep()) ids.push_back(query.getColumn(0).getInt64());
    transaction.commit();
    return ids;
  });
}

std::optional<std::string> Store::result(std::int64_t id) {
  return read([&](SQLite::Database& db) -> std::optional<std::string> {
    SQLite::Statement query(db, "SELECT body FROM results WHERE simulation = ?");
    query.bind(1, id);
    if (!query.executeStep()) return std::nullopt;
    return query.getColumn(0).getString();
  });
}

Store::HistoryShape Store::history_shape(std::int64_t id) {
  return read([&](SQLite::Database& db) {
    SQLite::Statement query(
        db, "SELECT name, length(data) / 8 FROM history WHERE simulation = ? ORDER BY position");
    query.bind(1, id);
    HistoryShape shape;
    while (query.executeStep()) {
      shape.names.push_back(query.getColumn(0).getString());
      shape.rows = query.getColumn(1).getInt64();
    }
    return shape;
  });
}

std::vector<double> Store::history_rows(std::int64_t id, const std::string& column,
                                        std::int64_t start, std::int64_t count) {
  return read([&](SQLite::Database& db) {
    SQLite::Statement query(db, "SELECT id FROM history WHERE simulation = ? AND name = ?");
    query.bind(1, id);
    query.bind(2, column);
    if (!query.executeStep()) throw SQLite::Exception("no such history column");
    return BlobReader(db, query.getColumn(0).getInt64()).read(start, count);
  });
}

}  // namespace tribodyn::server
