#include "server/store/maintenance.h"

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <map>

#include "server/hash/sha256.h"
#include "server/store/connections.h"
#include "server/store/database_lock.h"
#include "server/store/history_rows.h"
#include "server/store/properties.h"
#include "server/store/resource_types.h"
#include "server/store/schema.h"
#include "server/store/store_error.h"
#include "server/store/translate_error.h"
#include "tribodyn/v1/results.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {
namespace {

using Problems = std::vector<std::string>;

constexpr std::size_t kMaximumProblems = 100;
constexpr int kPagesAtATime = 1000;

Connection open(const std::filesystem::path& path, int flags) {
  if ((flags & SQLite::OPEN_CREATE) == 0 && !std::filesystem::exists(path)) {
    throw StoreError(StoreError::Kind::kCannotOpen, "there is no database " + path.string());
  }
  return {path.string(), flags, kBusyTimeoutMilliseconds};
}

int pragma(Connection& db, const std::string& name) {
  return db.execAndGet("PRAGMA " + name).getInt();
}

/// Runs a query that selects what must not be; each row is a sentence.
void find_rows(Connection& db, const char* sql, Problems& problems) {
  SQLite::Statement query(db, sql);
  while (problems.size() < kMaximumProblems && query.executeStep()) {
    problems.push_back(query.getColumn(0).getString());
  }
}

void check_file(Connection& db, Problems& problems) {
  SQLite::Statement integrity(db, "PRAGMA integrity_check(20)");
  while (integrity.executeStep()) {
    const std::string row = integrity.getColumn(0).getString();
    if (row != "ok") problems.push_back(row);
  }
  SQLite::Statement keys(db, "PRAGMA foreign_key_check");
  while (problems.size() < kMaximumProblems && keys.executeStep()) {
    problems.push_back("a row of " + keys.getColumn(0).getString() + " points at a row of " +
                       keys.getColumn(2).getString() + " that is not there");
  }
}

void check_rows(Connection& db, Problems& problems) {
  for (const char* sql : {
           "SELECT r.name || ': revisions have gaps' FROM resources r JOIN revisions v "
           "ON v.resource = r.id GROUP BY r.id "
           "HAVING count(*) <> max(v.revision) OR min(v.revision) <> 1",
           "SELECT r.name || ': its present revision is not its last' FROM resources r "
           "LEFT JOIN revisions v ON v.id = r.present AND v.resource = r.id "
           "WHERE v.revision IS NOT "
           "(SELECT max(revision) FROM revisions WHERE resource = r.id)",
           "SELECT r.name || ': revision times run backwards' FROM resources r "
           "JOIN revisions a ON a.resource = r.id JOIN revisions b ON b.resource = r.id "
           "AND b.revision = a.revision + 1 WHERE b.create_time < a.create_time",
           "SELECT name || ': no known kind of resource' FROM resources "
           "WHERE collection NOT IN ('lubricants', 'gearSets', 'surfaces', 'vehicles')",
           "SELECT 'simulations/' || s.id || ': its events have gaps' FROM simulations s "
           "WHERE (SELECT count(*) FROM events WHERE simulation = s.id) <> s.sequence OR "
           "(SELECT coalesce(max(sequence), 0) FROM events WHERE simulation = s.id) <> s.sequence",
           "SELECT 'simulations/' || s.id || ': its last event is of another state' "
           "FROM simulations s JOIN events e ON e.simulation = s.id AND e.sequence = s.sequence "
           "WHERE e.state <> s.state OR e.attempt <> s.attempt",
           "SELECT 'simulations/' || a.simulation || ': its states move backwards' "
           "FROM events a JOIN events b ON b.simulation = a.simulation "
           "AND b.sequence = a.sequence + 1 WHERE a.state > 2 OR b.attempt < a.attempt OR "
           "(b.attempt = a.attempt AND b.state <= a.state)",
           "SELECT 'inputs ' || input_hash || ': more than one result' FROM results "
           "WHERE platform <> '' GROUP BY input_hash, model_version, platform "
           "HAVING count(*) > 1",
           "SELECT 'simulations/' || s.id || ': columns of its history differ in length' "
           "FROM simulations s JOIN history_columns h ON h.result = s.result GROUP BY s.id "
           "HAVING min(rows) <> max(rows)",
       }) {
    find_rows(db, sql, problems);
  }
}

void check_histories(Connection& db, Problems& problems) {
  SQLite::Statement query(db, "SELECT id, result FROM history_columns");
  while (problems.size() < kMaximumProblems && query.executeStep()) {
    if (is_whole_column(db, query.getColumn(0).getInt64())) continue;
    problems.push_back("result " + query.getColumn(1).getString() + ": its history is damaged");
  }
}

bool bears_name(const google::protobuf::Message& message, const std::string& name) {
  return message.GetReflection()->GetString(
             message, message.GetDescriptor()->FindFieldByName("name")) == name;
}

void check_bodies(Connection& db, Problems& problems) {
  SQLite::Statement query(db,
                          "SELECT r.name, v.revision, v.content_hash, v.body FROM revisions v "
                          "JOIN resources r ON r.id = v.resource ORDER BY v.id");
  while (problems.size() < kMaximumProblems && query.executeStep()) {
    const std::string name = query.getColumn(0).getString();
    const std::string revision = name + "@" + query.getColumn(1).getString();
    const std::string body = query.getColumn(3).getString();
    if (sha256(body) != query.getColumn(2).getString()) {
      problems.push_back(revision + ": its content is not what was written");
      continue;
    }
    const auto message = new_resource(collection_of(name));
    if (!message || !message->ParseFromString(body)) {
      problems.push_back(revision + ": cannot be read");
    } else if (!bears_name(*message, name)) {
      problems.push_back(revision + ": holds another resource");
    }
  }
}

std::map<std::string, PropertyValue> stored_properties(Connection& db, std::int64_t id) {
  SQLite::Statement query(db, "SELECT key, value FROM properties WHERE resource = ?");
  query.bind(1, id);
  std::map<std::string, PropertyValue> out;
  while (query.executeStep()) {
    const SQLite::Column value = query.getColumn(1);
    PropertyValue& held = out[query.getColumn(0).getString()];
    if (value.isInteger()) held = value.getInt64();
    if (value.isFloat()) held = value.getDouble();
    if (value.isText()) held = value.getString();
  }
  return out;
}

void check_properties(Connection& db, Problems& problems) {
  SQLite::Statement query(db,
                          "SELECT r.id, r.name, r.collection, v.body, r.create_time, v.create_time "
                          "FROM resources r JOIN revisions v ON v.id = r.present");
  while (problems.size() < kMaximumProblems && query.executeStep()) {
    std::map<std::string, PropertyValue> expected;
    for (Property& each :
         properties_of(query.getColumn(2).getString(), query.getColumn(3).getString(),
                       query.getColumn(4).getInt64(), query.getColumn(5).getInt64())) {
      expected[each.key] = std::move(each.value);
    }
    if (stored_properties(db, query.getColumn(0).getInt64()) == expected) continue;
    problems.push_back(query.getColumn(1).getString() +
                       ": what it is found by is not what it holds");
  }
}

std::optional<std::string> revision_body(Connection& db, const std::string& name, int revision) {
  SQLite::Statement query(db,
                          "SELECT v.body FROM revisions v JOIN resources r ON r.id = v.resource "
                          "WHERE r.name = ? AND v.revision = ?");
  query.bind(1, name);
  query.bind(2, revision);
  if (!query.executeStep()) return std::nullopt;
  return query.getColumn(0).getString();
}

void check_simulations(Connection& db, const HashInputs& hash_inputs, Problems& problems) {
  const FindRevision find = [&db](const std::string& name, int revision) {
    return revision_body(db, name, revision);
  };
  SQLite::Statement query(
      db,
      "SELECT s.id, s.request, s.input_hash, b.body, "
      "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = s.lubricant), "
      "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = s.gear_set), "
      "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = s.surface), "
      "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = s.vehicle) "
      "FROM simulations s LEFT JOIN results b ON b.id = s.result");
  while (problems.size() < kMaximumProblems && query.executeStep()) {
    const std::string name = "simulations/" + query.getColumn(0).getString();
    const std::string hash = query.getColumn(2).getString();
    v1::Simulation request;
    if (!request.ParseFromString(query.getColumn(1).getString())) {
      problems.push_back(name + ": its request cannot be read");
    }
    if (query.getColumn(3).isNull()) continue;
    v1::SimulationResult result;
    if (!result.ParseFromString(query.getColumn(3).getString())) {
      problems.push_back(name + ": its result cannot be read");
    } else if (result.input_hash() != hash) {
      problems.push_back(name + ": its result is of other inputs");
    } else if (hash_inputs) {
      request.set_lubricant(query.getColumn(4).getString());
      request.set_gear_set(query.getColumn(5).getString());
      request.set_surface(query.getColumn(6).getString());
      request.set_vehicle(query.getColumn(7).getString());
      const auto again = hash_inputs(request, result.model_version(), find);
      if (again && *again != hash) problems.push_back(name + ": its inputs have another hash");
    }
  }
}

/// Refuses what is not a database of this program or of a newer one.
void check_identity(Connection& db, const std::filesystem::path& path) {
  if (pragma(db, "application_id") != kApplicationId) {
    throw StoreError(StoreError::Kind::kForeign, path.string() + " is no database of this program");
  }
  if (pragma(db, "user_version") > kSchemaVersion) {
    throw StoreError(StoreError::Kind::kNewerSchema,
                     path.string() + " was written by a newer tribodynd");
  }
}

Problems problems_of(Connection& db, const std::filesystem::path& path,
                     const HashInputs& hash_inputs = nullptr) {
  check_identity(db, path);
  Problems problems;
  check_file(db, problems);
  if (!problems.empty()) return problems;
  if (pragma(db, "user_version") < kSchemaVersion) return problems;  // the next start migrates it
  db.exec("BEGIN");  // one moment of a database in use
  check_rows(db, problems);
  check_histories(db, problems);
  check_bodies(db, problems);
  check_properties(db, problems);
  check_simulations(db, hash_inputs, problems);
  db.exec("COMMIT");
  return problems;
}

/// SQLite's and the file system's failures as StoreError.
template <class Action>
auto translated(const std::filesystem::path& path, const Action& action) {
  try {
    return action();
  } catch (const SQLite::Exception& error) {
    throw translate_error(error, path);
  } catch (const std::filesystem::filesystem_error& error) {
    throw StoreError(StoreError::Kind::kFailed, error.what());
  }
}

/// A file under construction beside the one that it is to be: gone unless it is finished.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(const std::filesystem::path& target)
      : target_(target), path_(target.string() + ".new") {
    std::filesystem::remove(path_);
  }
  ~UnfinishedFile() {
    std::error_code ignored;
    for (const char* suffix : {"", "-journal", "-wal", "-shm"}) {
      std::filesystem::remove(path_.string() + suffix, ignored);
    }
  }
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void finish() const { std::filesystem::rename(path_, target_); }

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
};

/// Copies page by page into a new file and has it on disk when it returns.
void copy_pages(Connection& from, const std::filesystem::path& to) {
  translated(to, [&] {
    Connection target = open(to, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    SQLite::Backup backup(target, from);
    while (backup.executeStep(kPagesAtATime) != SQLITE_DONE) {
      if (backup.getRemainingPageCount() > 0) usleep(1000);
    }
  });
  const int descriptor = ::open(to.c_str(), O_RDONLY | O_CLOEXEC);
  const bool saved = descriptor >= 0 && fsync(descriptor) == 0;
  if (descriptor >= 0) close(descriptor);
  if (!saved) throw StoreError(StoreError::Kind::kFailed, to.string() + " cannot be written");
}

/// Moves a database with what belongs to it.
void move_aside(const std::filesystem::path& database) {
  for (const char* suffix : {"-wal", "-shm", ""}) {
    const std::filesystem::path from = database.string() + suffix;
    const std::filesystem::path to = database.string() + ".replaced" + suffix;
    std::filesystem::remove(to);
    if (std::filesystem::exists(from)) std::filesystem::rename(from, to);
  }
}

}  // namespace

void backup_database(const std::filesystem::path& database, const std::filesystem::path& copy) {
  translated(database, [&] {
    if (std::filesystem::exists(copy)) {
      throw StoreError(StoreError::Kind::kFailed,
                       copy.string() + " exists; name a file that does not");
    }
    Connection source = open(database, SQLite::OPEN_READONLY);
    check_identity(source, database);
    const UnfinishedFile unfinished(copy);
    copy_pages(source, unfinished.path());
    Connection copied = open(unfinished.path(), SQLite::OPEN_READONLY);
    const Problems problems = problems_of(copied, unfinished.path());
    if (!problems.empty()) {
      throw StoreError(StoreError::Kind::kCorrupt, database.string() +
                                                       " is damaged, no backup was "
                                                       "made: " +
                                                       problems.front());
    }
    unfinished.finish();
  });
}

void restore_database(const std::filesystem::path& copy, const std::filesystem::path& database) {
  translated(copy, [&] {
    std::error_code ignored;
    const auto found = std::filesystem::weakly_canonical(database, ignored);
    const std::filesystem::path target = found.empty() ? database : found;
    if (std::filesystem::exists(target) && std::filesystem::equivalent(copy, target)) {
      throw StoreError(StoreError::Kind::kFailed, copy.string() + " is the database itself");
    }
    const DatabaseLock lock(target);
    Connection source = open(copy, SQLite::OPEN_READONLY);
    const Problems problems = problems_of(source, copy);
    if (!problems.empty()) {
      throw StoreError(StoreError::Kind::kCorrupt,
                       copy.string() + " is damaged: " + problems.front());
    }
    const UnfinishedFile unfinished(target);
    copy_pages(source, unfinished.path());
    move_aside(target);
    unfinished.finish();
  });
}

std::vector<std::string> check_database(const std::filesystem::path& database,
                                        const HashInputs& hash_inputs) {
  return translated(database, [&] {
    Connection db = open(database, SQLite::OPEN_READONLY);
    return problems_of(db, database, hash_inputs);
  });
}

}  // namespace tribodyn::server
