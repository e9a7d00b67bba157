#include "server/storage/schema.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/storage/checksum.h"
#include "server/storage/history_rows.h"
#include "server/storage/resource_rows.h"
#include "server/storage/resource_types.h"
#include "server/storage/schema_texts.h"
#include "server/storage/simulation_rows.h"
#include "server/support/random_bytes.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {
namespace {

/// Schema 1 left out zeros; since then what is left out is not known.
std::string with_explicit_zeros(const std::string& name, const std::string& body) {
  const std::unique_ptr<google::protobuf::Message> message = new_resource(collection_of(name));
  if (!message || !message->ParseFromString(body)) return body;
  set_missing_numbers(*message);
  return message->SerializeAsString();
}

void move_resources(Connection& db, Microseconds now) {
  SQLite::Statement old(db, "SELECT name, body FROM resources_of_schema_1 ORDER BY name");
  while (old.executeStep()) {
    const std::string name = old.getColumn(0).getString();
    insert_resource(db, {name, with_explicit_zeros(name, old.getColumn(1).getString())}, now);
  }
  old.reset();
  db.exec("DROP TABLE resources_of_schema_1");
}

/// A name that the request leaves out means the default of schema 1.
void pin_simulations(Connection& db) {
  SQLite::Statement query(db, "SELECT id, request FROM simulations");
  Prepared pin(db,
               "UPDATE simulations SET "
               "lubricant = (SELECT present FROM resources WHERE name = ?2), "
               "gear_set = (SELECT present FROM resources WHERE name = ?3), "
               "surface = (SELECT present FROM resources WHERE name = ?4), "
               "vehicle = (SELECT present FROM resources WHERE name = ?5) WHERE id = ?1");
  const auto stated_or = [](const std::string& stated, const char* otherwise) {
    return stated.empty() ? otherwise : stated;
  };
  while (query.executeStep()) {
    v1::Simulation request;
    if (!request.ParseFromString(query.getColumn(1).getString())) continue;
    pin.run(query.getColumn(0).getInt64(), request.lubricant(),
            stated_or(request.gear_set(), "gearSets/A"),
            stated_or(request.surface(), "surfaces/run-in"),
            stated_or(request.vehicle(), "vehicles/passenger-car"));
  }
}

/// Assumptions leave the results, and these say which model they are of.
void split_ledgers(Connection& db) {
  SQLite::Statement query(db, "SELECT id, body FROM results");
  Prepared keep(db, "UPDATE results SET body = ?2, model_version = ?3 WHERE id = ?1");
  Prepared refer(db, "UPDATE simulations SET ledger = ?2 WHERE result = ?1");
  while (query.executeStep()) {
    v1::SimulationResult result;
    if (!result.ParseFromString(query.getColumn(1).getString())) continue;
    v1::SimulationResult ledger;
    ledger.mutable_assumptions()->Swap(result.mutable_assumptions());
    keep.run(query.getColumn(0).getInt64(), Blob{result.SerializeAsString()},
             result.model_version());
    refer.run(query.getColumn(0).getInt64(), ledger_row(db, ledger.SerializeAsString()));
  }
}

/// Histories were one blob a column.
void compress_histories(Connection& db) {
  SQLite::Statement query(
      db, "SELECT result, position, name, data FROM history_of_schema_3 ORDER BY result, position");
  while (query.executeStep()) {
    const SQLite::Column data = query.getColumn(3);
    StoredColumn column{query.getColumn(2).getString(), {}};
    column.values.resize(static_cast<std::size_t>(data.getBytes()) / sizeof(double));
    std::memcpy(column.values.data(), data.getBlob(), column.values.size() * sizeof(double));
    insert_history_column(db, query.getColumn(0).getInt64(), query.getColumn(1).getInt64(),
                          compress(column));
  }
  query.reset();
  db.exec("DROP TABLE history_of_schema_3");
}

/// Of what was written without checksums; whatever has changed since then goes unnoticed.
void add_checksums(Connection& db) {
  db.exec("UPDATE history_blocks SET checksum = checksum(data)");
  db.exec(
      "UPDATE results SET checksum = checksum(body), stored_bytes = length(body) + "
      "(SELECT coalesce(sum(length(b.data)), 0) FROM history_columns c "
      "JOIN history_blocks b ON b.history_column = c.id WHERE c.result = results.id)");
}

/// The key of page tokens is made with the table, so that there always is one.
void start_token_log(Connection& db) {
  execute(db, "INSERT INTO token_log VALUES (1, 0, 0, ?)", Blob{random_bytes(32)});
}

static_assert(std::size(kSchemas) == kSchemaVersion);

void bring_from(Connection& database, int from, int to, Microseconds now) {
  for (int version = from + 1; version <= to; ++version) {
    database.exec(kSchemas[version - 1]);
    if (version == 2) {
      move_resources(database, now);
      pin_simulations(database);
    }
    if (version == 3) split_ledgers(database);
    if (version == 3 || version == 8 || version == 10) database.exec(kEventTriggers);
    // It writes blocks as schema 5 has them.
    if (from < 4 && version == std::clamp(to, 4, 5)) compress_histories(database);
    if (version == 5) {
      add_checksum_function(database);
      add_checksums(database);
    }
    if (version == 9) start_token_log(database);
  }
  database.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.exec("PRAGMA user_version = " + std::to_string(to));
}

/// The SQL text of each table, index, trigger and view, by kind and name.
using SchemaText = std::map<std::string, std::string>;

SchemaText schema_text(Connection& db) {
  SQLite::Statement query(db,
                          "SELECT type || ' ' || name, sql FROM sqlite_master "
                          "WHERE name NOT LIKE 'sqlite!_%' ESCAPE '!'");
  SchemaText out;
  while (query.executeStep()) out[query.getColumn(0).getString()] = query.getColumn(1).getString();
  return out;
}

SchemaText text_of_schema(int version) {
  Connection made(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  bring_from(made, 0, version, 0);
  return schema_text(made);
}

/// As text_of_schema, made once a process. Safe for concurrent access.
const SchemaText& expected_schema(int version) {
  static std::mutex mutex;
  static std::map<int, SchemaText> made;  // guarded by mutex; entries never change
  const std::lock_guard lock(mutex);
  auto found = made.find(version);
  if (found == made.end()) found = made.emplace(version, text_of_schema(version)).first;
  return found->second;
}

}  // namespace

void migrate(Connection& database, int from, Microseconds now) {
  SQLite::Transaction transaction(database);
  bring_from(database, from, kSchemaVersion, now);
  transaction.commit();
}

std::vector<std::string> schema_differences(Connection& database) {
  const int version = database.execAndGet("PRAGMA user_version").getInt();
  if (version < 1 || version > kSchemaVersion) {
    return {"its schema is numbered " + std::to_string(version) + ", this program knows 1 to " +
            std::to_string(kSchemaVersion)};
  }
  const SchemaText& expected = expected_schema(version);
  const SchemaText found = schema_text(database);
  std::vector<std::string> out;
  for (const auto& [name, text] : expected) {
    const auto match = found.find(name);
    if (match == found.end()) {
      out.push_back("its " + name + " is missing");
    } else if (match->second != text) {
      out.push_back("its " + name + " is not the one that this program makes");
    }
  }
  for (const auto& [name, text] : found) {
    if (!expected.contains(name)) out.push_back("its " + name + " is not of this program");
  }
  return out;
}

}  // namespace tribodyn::server
