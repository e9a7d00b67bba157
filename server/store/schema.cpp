#include "server/store/schema.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>

#include <memory>
#include <string>

#include "server/store/resource_rows.h"
#include "server/store/resource_types.h"
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

/// Schema 1 left out zeros; since then what is left out is not known.
std::string with_explicit_zeros(const std::string& name, const std::string& body) {
  const std::unique_ptr<google::protobuf::Message> message = new_resource(collection_of(name));
  if (!message || !message->ParseFromString(body)) return body;
  set_missing_numbers(*message);
  return message->SerializeAsString();
}

void move_resources(SQLite::Database& db, Microseconds now) {
  SQLite::Statement old(db, "SELECT name, body FROM resources_of_schema_1 ORDER BY name");
  while (old.executeStep()) {
    const std::string name = old.getColumn(0).getString();
    insert_resource(db, {name, with_explicit_zeros(name, old.getColumn(1).getString())}, now);
  }
  old.reset();
  db.exec("DROP TABLE resources_of_schema_1");
}

/// A name that the request leaves out means the default of schema 1.
void pin_simulations(SQLite::Database& db) {
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

}  // namespace

void migrate(SQLite::Database& database, int from, Microseconds now) {
  SQLite::Transaction transaction(database);
  if (from < 1) database.exec(kSchema1);
  if (from < 2) {
    database.exec(kSchema2);
    move_resources(database, now);
    pin_simulations(database);
  }
  database.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  transaction.commit();
}

}  // namespace tribodyn::server
