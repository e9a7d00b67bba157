#include "server/storage/database_check.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <map>
#include <optional>
#include <system_error>

#include "server/contract/resource_kinds.h"
#include "server/contract/resource_names.h"
#include "server/storage/campaign_tiles.h"
#include "server/storage/checksum.h"
#include "server/storage/history_rows.h"
#include "server/storage/properties.h"
#include "server/storage/resource_types.h"
#include "server/storage/store_error.h"
#include "server/support/sha256.h"
#include "tribodyn/v1/results.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {
namespace {

constexpr std::size_t kMaximumProblems = 100;

int pragma(Connection& db, const std::string& name) {
  return db.execAndGet("PRAGMA " + name).getInt();
}

/// Returns true if the database is empty, so that a server would create its tables.
bool is_new(Connection& db) {
  return db.execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0 &&
         pragma(db, "user_version") == 0 && pragma(db, "application_id") == 0;
}

/// Returns the fingerprint that a database holds; empty if it holds none.
std::string fingerprint_of(Connection& db) try {
  return db.execAndGet("SELECT max(fingerprint) FROM format").getString();
} catch (const SQLite::Exception& error) {
  if (error.getErrorCode() == SQLITE_ERROR) return {};  // there is no such table
  throw;
}

/// Makes the connection leave a write-ahead log as it is when it closes: SQLite would write the
/// changes of a killed server into the database file.
void keep_log(Connection& db) {
  const char* log = sqlite3_filename_wal(sqlite3_db_filename(db.getHandle(), "main"));
  std::error_code missing;
  if (std::filesystem::file_size(log, missing) == 0 || missing) return;
  sqlite3_db_config(db.getHandle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
}

/// Runs a query whose rows are problems: each row is a sentence.
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
    problems.push_back("a row of " + keys.getColumn(0).getString() + " refers to a row of " +
                       keys.getColumn(2).getString() + " that does not exist");
  }
}

void check_rows(Connection& db, Problems& problems) {
  find_rows(db,
            fmt::format("SELECT name || ': unknown kind of resource, or unknown project' "
                        "FROM resources WHERE collection NOT IN (SELECT CASE p.name "
                        "WHEN 'default' THEN '' ELSE 'projects/' || p.name || '/' END || "
                        "kind.column1 FROM projects p, (VALUES ('{}')) kind)",
                        fmt::join(kResourceCollections, "'), ('"))
                .c_str(),
            problems);
  for (const char* sql : {
           "SELECT r.name || ': revisions have gaps' FROM resources r JOIN revisions v "
           "ON v.resource = r.id GROUP BY r.id "
           "HAVING count(*) <> max(v.revision) OR min(v.revision) <> 1",
           "SELECT r.name || ': its current revision is not its last one' FROM resources r "
           "LEFT JOIN revisions v ON v.id = r.present AND v.resource = r.id "
           "WHERE v.revision IS NOT "
           "(SELECT max(revision) FROM revisions WHERE resource = r.id)",
           "SELECT (SELECT name FROM simulation_names n WHERE n.simulation = s.id) || "
           "': its project does not exist or has given no such number' FROM simulations s "
           "WHERE NOT EXISTS (SELECT 1 FROM projects p WHERE p.name = s.project AND "
           "s.number BETWEEN 1 AND p.last_number)",
           "SELECT (SELECT name FROM simulation_names n WHERE n.simulation = s.id) || "
           "': its result belongs to another project' "
           "FROM simulations s JOIN results r ON r.id = s.result WHERE r.project <> s.project",
           "SELECT (SELECT name FROM simulation_names n WHERE n.simulation = s.id) || "
           "': its events have gaps' FROM simulations s "
           "WHERE (SELECT count(*) FROM events WHERE simulation = s.id) <> s.sequence OR "
           "(SELECT coalesce(max(sequence), 0) FROM events WHERE simulation = s.id) <> s.sequence",
           "SELECT (SELECT name FROM simulation_names n WHERE n.simulation = s.id) || "
           "': its last event has another state' "
           "FROM simulations s JOIN events e ON e.simulation = s.id AND e.sequence = s.sequence "
           "WHERE e.state <> s.state OR e.attempt <> s.attempt",
           "SELECT (SELECT name FROM simulation_names n WHERE n.simulation = a.simulation) || "
           "': its states move backwards' "
           "FROM events a JOIN events b ON b.simulation = a.simulation "
           "AND b.sequence = a.sequence + 1 WHERE a.state > 2 OR b.attempt < a.attempt OR "
           "(b.attempt = a.attempt AND b.state <= a.state)",
           "SELECT 'event ' || number || ' of ' || project || ': its simulation does not exist' "
           "FROM "
           "events "
           "WHERE state <> 0 AND simulation NOT IN (SELECT id FROM simulations)",
           "SELECT 'event ' || number || ' of ' || project || ': its simulation was not deleted' "
           "FROM "
           "events "
           "WHERE state = 0 AND simulation IN (SELECT id FROM simulations)",
           "SELECT 'event ' || number || ' of ' || project || ': its project does not exist or has "
           "given no such number' FROM events e WHERE NOT EXISTS (SELECT 1 FROM projects p "
           "WHERE p.name = e.project AND e.number <= p.last_event AND "
           "coalesce(e.simulation_number, 1) BETWEEN 1 AND p.last_number)",
           "SELECT 'event ' || e.number || ' of ' || e.project || ': its simulation belongs to "
           "another project' FROM events e JOIN simulations s ON s.id = e.simulation "
           "WHERE s.project <> e.project",
           "SELECT 'event ' || b.number || ' of ' || b.project || ': it has a smaller number than "
           "the "
           "one before it' "
           "FROM events a JOIN events b ON b.simulation = a.simulation "
           "AND b.sequence = a.sequence + 1 WHERE b.number <= a.number",
           "SELECT 'the number of deleted simulations of ' || name || ' is wrong' FROM projects p "
           "WHERE deletions <> (SELECT count(*) FROM events e WHERE e.state = 0 AND "
           "e.project = p.name)",
           "SELECT 'the number of simulations of ' || name || ' is wrong' FROM projects p "
           "WHERE simulations <> (SELECT count(*) FROM simulations s WHERE s.project = p.name)",
           "SELECT 'result ' || id || ': its content differs from its checksum' FROM results "
           "WHERE checksum <> checksum(body)",
           "SELECT (SELECT name FROM simulation_names n WHERE n.simulation = s.id) || "
           "': columns of its history differ in length' "
           "FROM simulations s JOIN history_columns h ON h.result = s.result GROUP BY s.id "
           "HAVING min(rows) <> max(rows)",
           "SELECT 'campaign ' || c.number || ' of ' || c.project || ': its project does not exist "
           "or has given no such number' FROM campaigns c WHERE NOT EXISTS (SELECT 1 FROM projects "
           "p WHERE p.name = c.project AND c.number <= p.last_campaign)",
           "SELECT 'campaign ' || c.number || ' of ' || c.project || ': the number of its computed "
           "points is wrong' FROM campaigns c WHERE points_done <> "
           "(SELECT coalesce(sum(rows), 0) FROM campaign_tiles WHERE campaign = c.id)",
           "SELECT 'campaign ' || c.number || ' of ' || c.project || ': two tiles have the same "
           "rows, or a tile has none of it' FROM campaigns c WHERE EXISTS (SELECT 1 FROM "
           "(SELECT first_row + rows AS last, lead(first_row) OVER (ORDER BY first_row) AS next "
           "FROM campaign_tiles WHERE campaign = c.id) "
           "WHERE last > coalesce(next, c.candidates * c.conditions))",
           "SELECT 'campaign ' || c.number || ' of ' || c.project || ': rows of a tile are still "
           "suspected' FROM campaigns c WHERE EXISTS (SELECT 1 FROM campaign_suspects s JOIN "
           "campaign_tiles t ON t.campaign = s.campaign AND t.first_row < s.first_row + s.rows AND "
           "s.first_row < t.first_row + t.rows WHERE s.campaign = c.id)",
           "SELECT 'campaign ' || c.number || ' of ' || c.project || ': columns of a tile that it "
           "has not' FROM campaigns c WHERE EXISTS (SELECT 1 FROM campaign_blobs b WHERE "
           "b.campaign = c.id AND NOT EXISTS (SELECT 1 FROM campaign_tiles t WHERE "
           "t.campaign = b.campaign AND t.first_row = b.first_row))",
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

void check_tiles(Connection& db, Problems& problems) {
  SQLite::Statement query(db,
                          "SELECT t.campaign, t.first_row, t.rows, c.project, c.number, "
                          "(SELECT count(DISTINCT number) FROM campaign_blobs b "
                          "WHERE b.campaign = c.id) "
                          "FROM campaign_tiles t JOIN campaigns c ON c.id = t.campaign");
  while (problems.size() < kMaximumProblems && query.executeStep()) {
    const RowRange rows{query.getColumn(1).getInt64(), query.getColumn(2).getInt64()};
    const int columns = query.getColumn(5).getInt();
    if (columns > 0 && is_whole_tile(db, query.getColumn(0).getInt64(), rows, columns)) continue;
    problems.push_back(
        campaign_name(query.getColumn(3).getString(), query.getColumn(4).getInt64()) +
        ": its tile from row " + std::to_string(rows.first) + " on is damaged");
  }
}

void check_campaigns(Connection& db, Problems& problems) {
  SQLite::Statement query(db,
                          "SELECT request, request_checksum, candidate_table, table_checksum, "
                          "project, number FROM campaigns");
  while (problems.size() < kMaximumProblems && query.executeStep()) {
    const auto is_whole = [&](int column) {
      return checksum(bytes_of(query.getColumn(column))) == query.getColumn(column + 1).getInt64();
    };
    if (is_whole(0) && is_whole(2)) continue;
    problems.push_back(
        campaign_name(query.getColumn(4).getString(), query.getColumn(5).getInt64()) +
        ": its request or its candidates differ from their checksum");
  }
}

void check_ledgers(Connection& db, Problems& problems) {
  SQLite::Statement query(db, "SELECT id, content_hash, body FROM ledgers");
  while (problems.size() < kMaximumProblems && query.executeStep()) {
    if (sha256(bytes_of(query.getColumn(2))) == query.getColumn(1).getString()) continue;
    problems.push_back("ledger " + query.getColumn(0).getString() +
                       ": its content differs from its checksum");
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
      problems.push_back(revision + ": its content differs from its checksum");
      continue;
    }
    const auto message = new_resource(collection_of(name));
    if (!message || !message->ParseFromString(body)) {
      problems.push_back(revision + ": cannot be read");
    } else if (!bears_name(*message, relative_name(name))) {
      problems.push_back(revision + ": contains another resource");
    }
  }
}

std::map<std::string, PropertyValue> stored_properties(Connection& db, std::int64_t id) {
  Prepared query(db, "SELECT key, value FROM properties WHERE resource = ?", id);
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
                          "SELECT r.id, r.name, v.body, r.create_time, v.create_time "
                          "FROM resources r JOIN revisions v ON v.id = r.present");
  while (problems.size() < kMaximumProblems && query.executeStep()) {
    std::map<std::string, PropertyValue> expected;
    for (Property& each : properties_of(
             collection_of(query.getColumn(1).getString()), query.getColumn(2).getString(),
             query.getColumn(3).getInt64(), query.getColumn(4).getInt64())) {
      expected[each.key] = std::move(each.value);
    }
    if (stored_properties(db, query.getColumn(0).getInt64()) == expected) continue;
    problems.push_back(query.getColumn(1).getString() +
                       ": the search index does not match the stored resource");
  }
}

std::optional<std::string> revision_body(Connection& db, const std::string& name, int revision) {
  Prepared query(db,
                 "SELECT v.body FROM revisions v JOIN resources r ON r.id = v.resource "
                 "WHERE r.name = ? AND v.revision = ?",
                 name, revision);
  return query.first([](SQLite::Statement& row) { return row.getColumn(0).getString(); });
}

void check_simulations(Connection& db, const HashInputs& hash_inputs, Problems& problems) {
  SQLite::Statement query(
      db,
      "SELECT s.id, s.request, s.input_hash, b.body, "
      "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = s.lubricant), "
      "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = s.gear_set), "
      "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = s.surface), "
      "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = s.vehicle), "
      "s.project, s.number, s.request_checksum FROM simulations s LEFT JOIN results b ON b.id = "
      "s.result");
  while (problems.size() < kMaximumProblems && query.executeStep()) {
    const std::string project = query.getColumn(8).getString();
    const std::string name = simulation_name(project, query.getColumn(9).getInt64());
    const std::string hash = query.getColumn(2).getString();
    v1::Simulation request;
    if (!request.ParseFromString(query.getColumn(1).getString())) {
      problems.push_back(name + ": its request cannot be read");
    } else if (checksum(bytes_of(query.getColumn(1))) != query.getColumn(10).getInt64()) {
      problems.push_back(name + ": its request differs from its checksum");
    }
    if (query.getColumn(3).isNull()) continue;
    v1::SimulationResult result;
    if (!result.ParseFromString(query.getColumn(3).getString())) {
      problems.push_back(name + ": its result cannot be read");
    } else if (result.input_hash() != hash) {
      problems.push_back(name + ": its result belongs to other inputs");
    } else if (hash_inputs) {
      request.set_lubricant(relative_name(query.getColumn(4).getString()));
      request.set_gear_set(relative_name(query.getColumn(5).getString()));
      request.set_surface(relative_name(query.getColumn(6).getString()));
      request.set_vehicle(relative_name(query.getColumn(7).getString()));
      const FindRevision find = [&db, &project](const std::string& relative, int revision) {
        return revision_body(db, full_name(project, relative), revision);
      };
      const auto again = hash_inputs(request, result.model_version(), find);
      if (again && *again != hash) problems.push_back(name + ": its inputs have another hash");
    }
  }
}

}  // namespace

void check_identity(Connection& db, const std::filesystem::path& path, const SchemaSteps& steps) {
  const std::string name = "database " + path.string();
  if (pragma(db, "application_id") != kApplicationId) {
    throw StoreError(StoreError::Kind::kForeign,
                     name + (is_new(db) ? " is empty" : " belongs to another program"));
  }
  const int version = pragma(db, "user_version");
  if (0 < version && version <= static_cast<int>(steps.size()) &&
      fingerprint_of(db) == steps[static_cast<std::size_t>(version) - 1].fingerprint) {
    return;
  }
  keep_log(db);
  throw StoreError(
      StoreError::Kind::kOtherVersion,
      name +
          " was written by another development version of tribodynd, and before 0.1.0 versions "
          "do not read each other's databases: export its resources with that version "
          "(tribodyn lubricants export --all --file FILE; also gear-sets, surfaces and "
          "vehicles), or name a new file with --database");
}

void require_servable(Connection& db, const std::filesystem::path& path, const SchemaSteps& steps) {
  if (is_new(db)) return;
  check_identity(db, path, steps);
  const std::vector<std::string> differences = schema_differences(db, steps);
  if (differences.empty()) return;
  const std::size_t more = differences.size() - 1;
  throw StoreError(StoreError::Kind::kCorrupt,
                   "database " + path.string() +
                       " has another schema than that of tribodynd: " + differences.front() +
                       (more > 0 ? " (and " + std::to_string(more) + " more)" : ""));
}

Problems problems_of(Connection& db, const std::filesystem::path& path,
                     const HashInputs& hash_inputs, const SchemaSteps& steps) {
  if (is_new(db)) return {};
  check_identity(db, path, steps);
  Problems problems;
  check_file(db, problems);
  if (!problems.empty()) return problems;
  problems = schema_differences(db, steps);
  if (!problems.empty()) return problems;
  // the next start of a server migrates it
  if (pragma(db, "user_version") < static_cast<int>(steps.size())) return problems;
  add_checksum_function(db);
  db.exec("BEGIN");  // a snapshot: a server may write meanwhile
  check_rows(db, problems);
  check_histories(db, problems);
  check_tiles(db, problems);
  check_ledgers(db, problems);
  check_campaigns(db, problems);
  check_bodies(db, problems);
  check_properties(db, problems);
  check_simulations(db, hash_inputs, problems);
  db.exec("COMMIT");
  return problems;
}

}  // namespace tribodyn::server
