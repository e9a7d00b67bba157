#include "server/store/schema.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>

#include <cstring>
#include <memory>
#include <string>

#include "server/store/history_rows.h"
#include "server/store/resource_rows.h"
#include "server/store/resource_types.h"
#include "server/store/simulation_rows.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {
namespace {

constexpr char kSchema1[] = R"sql(
CREATE TABLE resources (
  name TEXT PRIMARY KEY,
  body BLOB NOT NULL
) STRICT;

CREATE TABLE simulations (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  state INTEGER NOT NULL CHECK (state BETWEEN 1 AND 5),
  create_time INTEGER NOT NULL,
  start_time INTEGER,
  end_time INTEGER,
  request BLOB NOT NULL,
  input_hash TEXT NOT NULL CHECK (length(input_hash) = 64),
  error_reason TEXT,
  error_message TEXT,
  CHECK ((state = 4) = (error_reason IS NOT NULL)),
  CHECK ((state >= 3) = (end_time IS NOT NULL))
) STRICT;
CREATE INDEX unfinished_simulations ON simulations (id) WHERE state IN (1, 2);
CREATE INDEX simulations_by_input ON simulations (input_hash);

CREATE TABLE results (
  simulation INTEGER PRIMARY KEY REFERENCES simulations (id) ON DELETE CASCADE,
  body BLOB NOT NULL
) STRICT;

CREATE TABLE history (
  id INTEGER PRIMARY KEY,
  simulation INTEGER NOT NULL REFERENCES simulations (id) ON DELETE CASCADE,
  position INTEGER NOT NULL,
  name TEXT NOT NULL,
  data BLOB NOT NULL,
  UNIQUE (simulation, position)
) STRICT;
)sql";

// A column that ALTER TABLE adds with a reference may be empty: so it is for a simulation of schema
// 1 whose request names what is not there.
constexpr char kSchema2[] = R"sql(
ALTER TABLE resources RENAME TO resources_of_schema_1;

CREATE TABLE resources (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  collection TEXT NOT NULL,
  present INTEGER NOT NULL REFERENCES revisions (id) DEFERRABLE INITIALLY DEFERRED,
  create_time INTEGER NOT NULL,
  delete_time INTEGER,
  CHECK (name GLOB collection || '/?*')
) STRICT;
CREATE UNIQUE INDEX resources_by_collection ON resources (collection, name);

CREATE TABLE revisions (
  id INTEGER PRIMARY KEY,
  resource INTEGER NOT NULL REFERENCES resources (id),
  revision INTEGER NOT NULL CHECK (revision >= 1),
  create_time INTEGER NOT NULL,
  content_hash TEXT NOT NULL CHECK (length(content_hash) = 64),
  body BLOB NOT NULL,
  UNIQUE (resource, revision)
) STRICT;
CREATE TRIGGER revisions_never_change BEFORE UPDATE ON revisions
BEGIN SELECT RAISE(ABORT, 'a revision never changes'); END;
CREATE TRIGGER revisions_stay BEFORE DELETE ON revisions
BEGIN SELECT RAISE(ABORT, 'a revision is never removed'); END;
CREATE TRIGGER revisions_follow_one_another BEFORE INSERT ON revisions
WHEN NEW.revision <> 1 + (SELECT count(*) FROM revisions WHERE resource = NEW.resource)
BEGIN SELECT RAISE(ABORT, 'a revision follows the last one'); END;

CREATE VIEW revision_names AS
SELECT v.id AS revision_id, r.name AS name, v.revision AS revision
FROM revisions v JOIN resources r ON r.id = v.resource;

CREATE TABLE properties (
  resource INTEGER NOT NULL REFERENCES resources (id),
  key TEXT NOT NULL,
  value ANY NOT NULL,
  collection TEXT NOT NULL,
  name TEXT NOT NULL,
  PRIMARY KEY (resource, key)
) STRICT, WITHOUT ROWID;
CREATE INDEX properties_by_value ON properties (collection, key, value, name);

ALTER TABLE simulations ADD COLUMN lubricant INTEGER REFERENCES revisions (id);
ALTER TABLE simulations ADD COLUMN gear_set INTEGER REFERENCES revisions (id);
ALTER TABLE simulations ADD COLUMN surface INTEGER REFERENCES revisions (id);
ALTER TABLE simulations ADD COLUMN vehicle INTEGER REFERENCES revisions (id);
)sql";

constexpr char kSchema3[] = R"sql(
DROP INDEX unfinished_simulations;
DROP INDEX simulations_by_input;
ALTER TABLE simulations RENAME TO simulations_of_schema_2;
ALTER TABLE results RENAME TO results_of_schema_2;
ALTER TABLE history RENAME TO history_of_schema_2;

CREATE TABLE ledgers (
  id INTEGER PRIMARY KEY,
  content_hash TEXT NOT NULL UNIQUE CHECK (length(content_hash) = 64),
  body BLOB NOT NULL
) STRICT;

CREATE TABLE results (
  id INTEGER PRIMARY KEY,
  input_hash TEXT NOT NULL CHECK (length(input_hash) = 64),
  model_version TEXT NOT NULL,
  platform TEXT NOT NULL,
  create_time INTEGER NOT NULL,
  body BLOB NOT NULL
) STRICT;
CREATE UNIQUE INDEX one_result_per_input ON results (input_hash, model_version, platform)
WHERE platform <> '';

CREATE TABLE history (
  id INTEGER PRIMARY KEY,
  result INTEGER NOT NULL REFERENCES results (id) ON DELETE CASCADE,
  position INTEGER NOT NULL,
  name TEXT NOT NULL,
  data BLOB NOT NULL,
  UNIQUE (result, position)
) STRICT;

CREATE TABLE simulations (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  state INTEGER NOT NULL CHECK (state BETWEEN 1 AND 5),
  attempt INTEGER NOT NULL DEFAULT 1 CHECK (attempt >= 1),
  lost_attempts INTEGER NOT NULL DEFAULT 0 CHECK (lost_attempts < attempt OR state = 4),
  sequence INTEGER NOT NULL DEFAULT 0,
  create_time INTEGER NOT NULL,
  start_time INTEGER,
  end_time INTEGER,
  deadline_time INTEGER,
  request BLOB NOT NULL,
  request_id TEXT CHECK (length(request_id) > 0),
  request_hash TEXT NOT NULL DEFAULT '',
  is_forced INTEGER NOT NULL DEFAULT 0 CHECK (is_forced IN (0, 1)),
  cache_hit INTEGER NOT NULL DEFAULT 0 CHECK (cache_hit IN (0, 1)),
  input_hash TEXT NOT NULL CHECK (length(input_hash) = 64),
  result INTEGER REFERENCES results (id),
  ledger INTEGER REFERENCES ledgers (id),
  error_reason TEXT,
  error_message TEXT,
  lubricant INTEGER REFERENCES revisions (id),
  gear_set INTEGER REFERENCES revisions (id),
  surface INTEGER REFERENCES revisions (id),
  vehicle INTEGER REFERENCES revisions (id),
  CHECK ((state = 3) = (result IS NOT NULL)),
  CHECK ((state = 4) = (error_reason IS NOT NULL)),
  CHECK ((state >= 3) = (end_time IS NOT NULL))
) STRICT;

CREATE TABLE events (
  simulation INTEGER NOT NULL REFERENCES simulations (id) ON DELETE CASCADE,
  sequence INTEGER NOT NULL CHECK (sequence >= 1),
  time INTEGER NOT NULL,
  state INTEGER NOT NULL CHECK (state BETWEEN 1 AND 5),
  attempt INTEGER NOT NULL CHECK (attempt >= 1),
  reason TEXT NOT NULL,
  PRIMARY KEY (simulation, sequence)
) STRICT, WITHOUT ROWID;

INSERT INTO results SELECT simulation, input_hash, '', '', end_time, body
FROM results_of_schema_2 JOIN simulations_of_schema_2 ON id = simulation;
INSERT INTO history SELECT id, simulation, position, name, data FROM history_of_schema_2;
INSERT INTO simulations (id, state, create_time, start_time, end_time, request, input_hash, result,
                         error_reason, error_message, lubricant, gear_set, surface, vehicle)
SELECT id, state, create_time, start_time, end_time, request, input_hash,
       CASE state WHEN 3 THEN id END,
       error_reason, error_message, lubricant, gear_set, surface, vehicle
FROM simulations_of_schema_2;
INSERT INTO events SELECT id, 1, create_time, 1, 1, '' FROM simulations;
INSERT INTO events SELECT id, 2, start_time, 2, 1, '' FROM simulations
WHERE start_time IS NOT NULL;
INSERT INTO events SELECT s.id, 1 + count(*), end_time, s.state, 1, ''
FROM simulations s JOIN events e ON e.simulation = s.id
WHERE end_time IS NOT NULL GROUP BY s.id;
UPDATE simulations SET sequence = (SELECT count(*) FROM events WHERE simulation = id);
DROP TABLE history_of_schema_2;
DROP TABLE results_of_schema_2;
DROP TABLE simulations_of_schema_2;

CREATE INDEX unfinished_simulations ON simulations (id) WHERE state IN (1, 2);
CREATE INDEX simulations_by_input ON simulations (input_hash);
CREATE UNIQUE INDEX one_simulation_per_request ON simulations (request_id);

CREATE TRIGGER states_move_forward BEFORE UPDATE OF state ON simulations
WHEN NOT (OLD.state = 1 AND NEW.state IN (2, 3, 4, 5) AND NEW.attempt = OLD.attempt OR
          OLD.state = 2 AND NEW.state IN (3, 4, 5) AND NEW.attempt = OLD.attempt OR
          OLD.state = 2 AND NEW.state = 1 AND NEW.attempt = OLD.attempt + 1)
BEGIN SELECT RAISE(ABORT, 'no such change of state'); END;
CREATE TRIGGER states_change_with_an_event BEFORE UPDATE OF state ON simulations
WHEN NEW.sequence <> OLD.sequence + 1
BEGIN SELECT RAISE(ABORT, 'a change of state is an event'); END;
CREATE TRIGGER events_follow_one_another BEFORE INSERT ON events
WHEN NEW.sequence <> 1 + (SELECT coalesce(max(sequence), 0) FROM events
                          WHERE simulation = NEW.simulation)
BEGIN SELECT RAISE(ABORT, 'an event follows the last one'); END;
CREATE TRIGGER events_never_change BEFORE UPDATE ON events
BEGIN SELECT RAISE(ABORT, 'an event never changes'); END;
)sql";

constexpr char kSchema4[] = R"sql(
ALTER TABLE history RENAME TO history_of_schema_3;

CREATE TABLE history_columns (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  result INTEGER NOT NULL REFERENCES results (id) ON DELETE CASCADE,
  position INTEGER NOT NULL,
  name TEXT NOT NULL,
  rows INTEGER NOT NULL CHECK (rows >= 0),
  UNIQUE (result, position)
) STRICT;

CREATE TABLE history_blocks (
  history_column INTEGER NOT NULL REFERENCES history_columns (id) ON DELETE CASCADE,
  level INTEGER NOT NULL CHECK (level >= 0),
  number INTEGER NOT NULL CHECK (number >= 0),
  data BLOB NOT NULL,
  UNIQUE (history_column, level, number)
) STRICT;

ALTER TABLE simulations ADD COLUMN pinned INTEGER NOT NULL DEFAULT 0 CHECK (pinned IN (0, 1));
ALTER TABLE simulations ADD COLUMN client TEXT NOT NULL DEFAULT '';
ALTER TABLE simulations ADD COLUMN cost_seconds REAL NOT NULL DEFAULT 0;

CREATE TABLE simulation_labels (
  key TEXT NOT NULL,
  value TEXT NOT NULL,
  simulation INTEGER NOT NULL REFERENCES simulations (id) ON DELETE CASCADE,
  PRIMARY KEY (key, value, simulation)
) STRICT, WITHOUT ROWID;
CREATE INDEX labels_of_simulation ON simulation_labels (simulation);

CREATE INDEX simulations_by_time ON simulations (create_time);
CREATE INDEX simulations_by_state ON simulations (state, create_time);
CREATE INDEX simulations_by_lubricant ON simulations (lubricant, create_time);
CREATE INDEX simulations_by_result ON simulations (result);
CREATE INDEX simulations_by_ledger ON simulations (ledger);
CREATE INDEX ended_simulations ON simulations (end_time) WHERE state >= 3 AND pinned = 0;
)sql";

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
  SQLite::Statement pin(db,
                        "UPDATE simulations SET "
                        "lubricant = (SELECT present FROM resources WHERE name = ?2), "
                        "gear_set = (SELECT present FROM resources WHERE name = ?3), "
                        "surface = (SELECT present FROM resources WHERE name = ?4), "
                        "vehicle = (SELECT present FROM resources WHERE name = ?5) WHERE id = ?1");
  const auto bind = [&pin](int index, const std::string& stated, const char* otherwise) {
    pin.bind(index, stated.empty() ? otherwise : stated);
  };
  while (query.executeStep()) {
    v1::Simulation request;
    if (!request.ParseFromString(query.getColumn(1).getString())) continue;
    pin.bind(1, query.getColumn(0).getInt64());
    bind(2, request.lubricant(), "");
    bind(3, request.gear_set(), "gearSets/A");
    bind(4, request.surface(), "surfaces/run-in");
    bind(5, request.vehicle(), "vehicles/passenger-car");
    pin.exec();
    pin.reset();
  }
}

/// Assumptions leave the results, and these say which model they are of.
void split_ledgers(Connection& db) {
  SQLite::Statement query(db, "SELECT id, body FROM results");
  SQLite::Statement keep(db, "UPDATE results SET body = ?2, model_version = ?3 WHERE id = ?1");
  SQLite::Statement refer(db, "UPDATE simulations SET ledger = ?2 WHERE result = ?1");
  while (query.executeStep()) {
    v1::SimulationResult result;
    if (!result.ParseFromString(query.getColumn(1).getString())) continue;
    v1::SimulationResult ledger;
    ledger.mutable_assumptions()->Swap(result.mutable_assumptions());
    keep.bind(1, query.getColumn(0).getInt64());
    bind_blob(keep, 2, result.SerializeAsString());
    keep.bind(3, result.model_version());
    keep.exec();
    keep.reset();
    refer.bind(1, query.getColumn(0).getInt64());
    refer.bind(2, ledger_row(db, ledger.SerializeAsString()));
    refer.exec();
    refer.reset();
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

}  // namespace

void migrate(Connection& database, int from, Microseconds now) {
  SQLite::Transaction transaction(database);
  if (from < 1) database.exec(kSchema1);
  if (from < 2) {
    database.exec(kSchema2);
    move_resources(database, now);
    pin_simulations(database);
  }
  if (from < 3) {
    database.exec(kSchema3);
    split_ledgers(database);
  }
  if (from < 4) {
    database.exec(kSchema4);
    compress_histories(database);
  }
  database.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  transaction.commit();
}

}  // namespace tribodyn::server
