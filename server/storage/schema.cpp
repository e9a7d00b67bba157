#include "server/storage/schema.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>

#include <map>
#include <mutex>

#include "server/storage/schema_texts.h"
#include "server/storage/wire_layout.h"
#include "server/support/random_bytes.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

/// The key of page tokens is made with the table, so that there always is one.
void start_token_log(Connection& db) {
  execute(db, "INSERT INTO token_log VALUES (1, 0, 0, ?)", Blob{random_bytes(32)});
}

void bring_from(Connection& database, int from, int to, const SchemaSteps& steps) {
  for (int version = from; version < to; ++version) {
    const SchemaStep& step = steps[static_cast<std::size_t>(version)];
    database.exec(step.text);
    if (step.convert != nullptr) step.convert(database);
  }
  execute(database, "INSERT OR REPLACE INTO format VALUES (1, ?)",
          steps[static_cast<std::size_t>(to) - 1].fingerprint);
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

SchemaText text_of_schema(int version, const SchemaSteps& steps) {
  Connection made(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  bring_from(made, 0, version, steps);
  return schema_text(made);
}

/// As text_of_schema, made once a process. Safe for concurrent access.
const SchemaText& expected_schema(int version, const SchemaSteps& steps) {
  static std::mutex mutex;
  static std::map<std::string, SchemaText> made;  // by fingerprint; guarded by mutex; never change
  const std::lock_guard lock(mutex);
  const std::string& fingerprint = steps[static_cast<std::size_t>(version) - 1].fingerprint;
  auto found = made.find(fingerprint);
  if (found == made.end()) found = made.emplace(fingerprint, text_of_schema(version, steps)).first;
  return found->second;
}

}  // namespace

const SchemaSteps& schema_steps() {
  static const SchemaSteps kSteps = {
      {kSchema1, start_token_log, sha256(kSchema1 + wire_layout(stored_messages()))}};
  return kSteps;
}

void migrate(Connection& database, int from, const SchemaSteps& steps) {
  SQLite::Transaction transaction(database);
  bring_from(database, from, static_cast<int>(steps.size()), steps);
  transaction.commit();
}

std::vector<std::string> schema_differences(Connection& database, const SchemaSteps& steps) {
  const SchemaText& expected =
      expected_schema(database.execAndGet("PRAGMA user_version").getInt(), steps);
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
