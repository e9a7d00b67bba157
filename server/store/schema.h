#pragma once

namespace tribodyn::server {

/// What is on disk, schema 1. Times are microseconds since 1970 (UTC). Messages are the protos of
/// tribodyn.v1 in binary form: field numbers never change meaning.
///
///   resources    lubricants, gear sets, surfaces, vehicles by name; never changed once written
///   simulations  one row per job; id is the number in "simulations/{id}" and the order of
///   creation.
///                state as in Simulation.State. request: the Simulation as the client stated it.
///                Progress is not kept: a job that a crash interrupts starts again.
///   results      one SimulationResult per job that succeeded, written with the change of state
///   history      columns of time histories, little-endian doubles, in the order of position
inline constexpr int kSchemaVersion = 1;
inline constexpr int kApplicationId = 0x54524244;  // "TRBD"

inline constexpr char kSchema[] = R"sql(
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

}  // namespace tribodyn::server
