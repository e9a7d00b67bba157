#pragma once

namespace tribodyn::server {

/// The tables of schema 1; schema.h says what they hold. Columns that may be long come last: SQLite
/// reads a row from its beginning.
inline constexpr char kSchema1[] = R"sql(
-- Bytes beside messages: compressed columns 1 (column_codec.h), levels of histories 1 (pyramid.h),
-- columns of tiles 2 (campaign_columns.h). Whoever changes one of them counts it up.
CREATE TABLE format (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  fingerprint TEXT NOT NULL CHECK (length(fingerprint) = 64)
) STRICT;

CREATE TABLE projects (
  name TEXT PRIMARY KEY CHECK (length(name) BETWEEN 1 AND 63),
  last_number INTEGER NOT NULL DEFAULT 0 CHECK (last_number >= 0),
  last_event INTEGER NOT NULL DEFAULT 0 CHECK (last_event >= 0),
  last_campaign INTEGER NOT NULL DEFAULT 0 CHECK (last_campaign >= 0),
  simulations INTEGER NOT NULL DEFAULT 0 CHECK (simulations >= 0),
  deletions INTEGER NOT NULL DEFAULT 0 CHECK (deletions >= 0),
  forgotten_event INTEGER NOT NULL DEFAULT 0 CHECK (forgotten_event BETWEEN 0 AND last_event)
) STRICT, WITHOUT ROWID;
INSERT INTO projects (name) VALUES ('default');

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
CREATE TRIGGER revisions_follow_one_another BEFORE INSERT ON revisions
WHEN NEW.revision <> 1 + (SELECT count(*) FROM revisions WHERE resource = NEW.resource)
BEGIN SELECT RAISE(ABORT, 'a revision follows the last one'); END;
CREATE TRIGGER revisions_never_change BEFORE UPDATE ON revisions
BEGIN SELECT RAISE(ABORT, 'a revision never changes'); END;
CREATE TRIGGER revisions_stay BEFORE DELETE ON revisions
BEGIN SELECT RAISE(ABORT, 'a revision is never removed'); END;

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

CREATE TABLE ledgers (
  id INTEGER PRIMARY KEY,
  content_hash TEXT NOT NULL UNIQUE CHECK (length(content_hash) = 64),
  body BLOB NOT NULL
) STRICT;

CREATE TABLE results (
  id INTEGER PRIMARY KEY,
  project TEXT NOT NULL DEFAULT 'default',
  input_hash TEXT NOT NULL CHECK (length(input_hash) = 64),
  model_version TEXT NOT NULL,
  platform TEXT NOT NULL CHECK (length(platform) > 0),
  create_time INTEGER NOT NULL,
  checksum INTEGER NOT NULL DEFAULT 0,
  stored_bytes INTEGER NOT NULL DEFAULT 0,
  body BLOB NOT NULL
) STRICT;
CREATE UNIQUE INDEX one_result_per_input ON results (project, input_hash, model_version, platform);
CREATE INDEX results_by_size ON results (id, stored_bytes);
CREATE INDEX results_by_project ON results (project, stored_bytes);
CREATE TRIGGER results_stay_in_their_project BEFORE UPDATE OF project ON results
BEGIN SELECT RAISE(ABORT, 'a result keeps its project'); END;

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
  checksum INTEGER NOT NULL DEFAULT 0,
  data BLOB NOT NULL,
  UNIQUE (history_column, level, number)
) STRICT;

CREATE TABLE simulations (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  project TEXT NOT NULL DEFAULT 'default',
  number INTEGER NOT NULL DEFAULT 0,
  state INTEGER NOT NULL CHECK (state BETWEEN 1 AND 5),
  attempt INTEGER NOT NULL DEFAULT 1 CHECK (attempt >= 1),
  lost_attempts INTEGER NOT NULL DEFAULT 0 CHECK (lost_attempts < attempt OR state = 4),
  sequence INTEGER NOT NULL DEFAULT 0,
  create_time INTEGER NOT NULL,
  start_time INTEGER,
  end_time INTEGER,
  deadline_time INTEGER,
  request_id TEXT CHECK (length(request_id) > 0),
  request_hash TEXT NOT NULL DEFAULT '',
  is_forced INTEGER NOT NULL DEFAULT 0 CHECK (is_forced IN (0, 1)),
  cache_hit INTEGER NOT NULL DEFAULT 0 CHECK (cache_hit IN (0, 1)),
  pinned INTEGER NOT NULL DEFAULT 0 CHECK (pinned IN (0, 1)),
  client TEXT NOT NULL DEFAULT '',
  principal TEXT NOT NULL DEFAULT '',
  scheduling_class INTEGER NOT NULL DEFAULT 0 CHECK (scheduling_class BETWEEN 0 AND 2),
  cost_seconds REAL NOT NULL DEFAULT 0,
  lease_worker TEXT CHECK (length(lease_worker) > 0),
  lease_expire_time INTEGER CHECK ((lease_worker IS NULL) = (lease_expire_time IS NULL)),
  input_hash TEXT NOT NULL CHECK (length(input_hash) = 64),
  lubricant INTEGER REFERENCES revisions (id),
  gear_set INTEGER REFERENCES revisions (id),
  surface INTEGER REFERENCES revisions (id),
  vehicle INTEGER REFERENCES revisions (id),
  result INTEGER REFERENCES results (id),
  ledger INTEGER REFERENCES ledgers (id),
  error_reason TEXT,
  error_message TEXT,
  request_checksum INTEGER NOT NULL,
  request BLOB NOT NULL,
  CHECK ((state = 3) = (result IS NOT NULL)),
  CHECK ((state = 4) = (error_reason IS NOT NULL)),
  CHECK ((state >= 3) = (end_time IS NOT NULL))
) STRICT;
CREATE UNIQUE INDEX simulations_by_number ON simulations (project, number);
CREATE UNIQUE INDEX one_simulation_per_request ON simulations (project, request_id);
CREATE INDEX simulations_by_time ON simulations (project, create_time, number);
CREATE INDEX simulations_by_state ON simulations (project, state, create_time, number);
CREATE INDEX simulations_by_input ON simulations (input_hash);
CREATE INDEX simulations_by_lubricant ON simulations (lubricant, create_time);
CREATE INDEX simulations_by_gear_set ON simulations (gear_set);
CREATE INDEX simulations_by_surface ON simulations (surface);
CREATE INDEX simulations_by_vehicle ON simulations (vehicle);
CREATE INDEX simulations_by_result ON simulations (result);
CREATE INDEX simulations_by_ledger ON simulations (ledger);
CREATE INDEX pinned_results ON simulations (result) WHERE pinned = 1;
CREATE INDEX unfinished_simulations ON simulations (id) WHERE state IN (1, 2);
CREATE INDEX ended_simulations ON simulations (end_time) WHERE state >= 3 AND pinned = 0;
CREATE TRIGGER simulations_are_counted AFTER INSERT ON simulations
BEGIN UPDATE projects SET simulations = simulations + 1 WHERE name = NEW.project; END;
CREATE TRIGGER removed_simulations_are_not_counted AFTER DELETE ON simulations
BEGIN UPDATE projects SET simulations = simulations - 1 WHERE name = OLD.project; END;
CREATE TRIGGER simulations_stay_in_their_project BEFORE UPDATE OF project, number ON simulations
BEGIN SELECT RAISE(ABORT, 'a simulation keeps its project and its number'); END;
CREATE TRIGGER states_move_forward BEFORE UPDATE OF state ON simulations
WHEN NOT (OLD.state = 1 AND NEW.state IN (2, 3, 4, 5) AND NEW.attempt = OLD.attempt OR
          OLD.state = 2 AND NEW.state IN (3, 4, 5) AND NEW.attempt = OLD.attempt OR
          OLD.state = 2 AND NEW.state = 1 AND NEW.attempt = OLD.attempt + 1)
BEGIN SELECT RAISE(ABORT, 'no such change of state'); END;
CREATE TRIGGER states_change_with_an_event BEFORE UPDATE OF state ON simulations
WHEN NEW.sequence <> OLD.sequence + 1
BEGIN SELECT RAISE(ABORT, 'a change of state is an event'); END;
CREATE TRIGGER running_means_leased BEFORE UPDATE OF state ON simulations
WHEN (NEW.state = 2) <> (NEW.lease_worker IS NOT NULL)
BEGIN SELECT RAISE(ABORT, 'a simulation runs under a lease'); END;

CREATE VIEW simulation_names AS
SELECT id AS simulation, CASE project WHEN 'default' THEN '' ELSE 'projects/' || project || '/' END ||
                         'simulations/' || number AS name
FROM simulations;

CREATE TABLE simulation_labels (
  key TEXT NOT NULL,
  value TEXT NOT NULL,
  simulation INTEGER NOT NULL REFERENCES simulations (id) ON DELETE CASCADE,
  PRIMARY KEY (key, value, simulation)
) STRICT, WITHOUT ROWID;
CREATE INDEX labels_of_simulation ON simulation_labels (simulation);

CREATE TABLE events (
  project TEXT NOT NULL,
  number INTEGER NOT NULL CHECK (number >= 1),
  simulation INTEGER NOT NULL,
  sequence INTEGER NOT NULL CHECK (sequence >= 1),
  time INTEGER NOT NULL,
  state INTEGER NOT NULL CHECK (state BETWEEN 0 AND 5),
  attempt INTEGER NOT NULL CHECK (attempt >= 1),
  reason TEXT NOT NULL,
  simulation_number INTEGER,
  PRIMARY KEY (project, number),
  UNIQUE (simulation, sequence),
  CHECK ((state = 0) = (simulation_number IS NOT NULL))
) STRICT, WITHOUT ROWID;
CREATE INDEX deletions ON events (project, number) WHERE state = 0;
CREATE UNIQUE INDEX deleted_simulations ON events (project, simulation_number) WHERE state = 0;
CREATE TRIGGER events_have_a_simulation BEFORE INSERT ON events
WHEN NOT EXISTS (SELECT 1 FROM simulations WHERE id = NEW.simulation AND project = NEW.project)
BEGIN SELECT RAISE(ABORT, 'an event belongs to a simulation of its project'); END;
CREATE TRIGGER events_follow_one_another BEFORE INSERT ON events
WHEN NEW.sequence <> 1 + (SELECT coalesce(max(sequence), 0) FROM events
                          WHERE simulation = NEW.simulation)
BEGIN SELECT RAISE(ABORT, 'an event follows the last one'); END;
CREATE TRIGGER events_never_change BEFORE UPDATE ON events
BEGIN SELECT RAISE(ABORT, 'an event never changes'); END;

CREATE TABLE campaigns (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  project TEXT NOT NULL REFERENCES projects (name),
  number INTEGER NOT NULL CHECK (number >= 1),
  state INTEGER NOT NULL CHECK (state BETWEEN 1 AND 5),
  stop_reason TEXT NOT NULL DEFAULT '',
  stop_message TEXT NOT NULL DEFAULT '',
  lost_attempts INTEGER NOT NULL DEFAULT 0 CHECK (lost_attempts >= 0),
  lost_candidates INTEGER NOT NULL DEFAULT 0 CHECK (lost_candidates >= 0),
  create_time INTEGER NOT NULL,
  end_time INTEGER,
  request_id TEXT CHECK (length(request_id) > 0),
  request_hash TEXT NOT NULL CHECK (length(request_hash) = 64),
  input_hash TEXT NOT NULL CHECK (length(input_hash) = 64),
  model_version TEXT NOT NULL,
  platform TEXT NOT NULL,
  client TEXT NOT NULL,
  principal TEXT NOT NULL,
  lubricant INTEGER NOT NULL REFERENCES revisions (id),
  gear_set INTEGER NOT NULL REFERENCES revisions (id),
  surface INTEGER NOT NULL REFERENCES revisions (id),
  vehicle INTEGER NOT NULL REFERENCES revisions (id),
  candidates INTEGER NOT NULL CHECK (candidates >= 1),
  conditions INTEGER NOT NULL CHECK (conditions >= 1),
  points_done INTEGER NOT NULL DEFAULT 0,
  points_refused INTEGER NOT NULL DEFAULT 0,
  cost_seconds REAL NOT NULL CHECK (cost_seconds >= 0),
  budget_seconds REAL NOT NULL CHECK (budget_seconds >= 0),
  budget_points INTEGER NOT NULL CHECK (budget_points >= 0),
  processor_seconds REAL NOT NULL DEFAULT 0,
  stored_bytes INTEGER NOT NULL,
  request_checksum INTEGER NOT NULL,
  table_checksum INTEGER NOT NULL,
  request BLOB NOT NULL,
  candidate_table BLOB NOT NULL,
  CHECK (points_done BETWEEN 0 AND candidates * conditions),
  CHECK (points_refused BETWEEN 0 AND points_done),
  CHECK ((state = 3) <= (points_done = candidates * conditions)),
  CHECK ((state >= 3) = (end_time IS NOT NULL))
) STRICT;
CREATE UNIQUE INDEX campaigns_by_number ON campaigns (project, number);
CREATE UNIQUE INDEX one_campaign_per_request ON campaigns (project, request_id);
CREATE INDEX campaigns_by_size ON campaigns (project, stored_bytes);
CREATE INDEX running_campaigns ON campaigns (id) WHERE state = 1;
CREATE INDEX ended_campaigns ON campaigns (end_time, stored_bytes) WHERE state >= 3;
CREATE INDEX campaigns_by_lubricant ON campaigns (lubricant);
CREATE INDEX campaigns_by_gear_set ON campaigns (gear_set);
CREATE INDEX campaigns_by_surface ON campaigns (surface);
CREATE INDEX campaigns_by_vehicle ON campaigns (vehicle);
CREATE TRIGGER campaigns_end_once BEFORE UPDATE OF state, stop_reason, stop_message, create_time,
  end_time, request_id, request_hash, input_hash, model_version, platform, client, principal,
  lubricant, gear_set, surface, vehicle, candidates, conditions, points_done, points_refused,
  cost_seconds, processor_seconds ON campaigns
WHEN OLD.state >= 3 AND NOT
  (OLD.state = 3 AND NEW.state = 1 AND NEW.candidates > OLD.candidates)
BEGIN SELECT RAISE(ABORT, 'a campaign that has ended changes only by further candidates'); END;
CREATE TRIGGER campaigns_stay_in_their_project BEFORE UPDATE OF project, number ON campaigns
BEGIN SELECT RAISE(ABORT, 'a campaign keeps its project and its number'); END;

CREATE TABLE campaign_labels (
  key TEXT NOT NULL,
  value TEXT NOT NULL,
  campaign INTEGER NOT NULL REFERENCES campaigns (id) ON DELETE CASCADE,
  PRIMARY KEY (key, value, campaign)
) STRICT, WITHOUT ROWID;
CREATE INDEX labels_of_campaign ON campaign_labels (campaign);

CREATE TABLE campaign_lubricants (
  campaign INTEGER NOT NULL REFERENCES campaigns (id) ON DELETE CASCADE,
  lubricant INTEGER NOT NULL REFERENCES revisions (id),
  PRIMARY KEY (campaign, lubricant)
) STRICT, WITHOUT ROWID;
CREATE INDEX campaigns_of_lubricant ON campaign_lubricants (lubricant);

CREATE TABLE campaign_appends (
  campaign INTEGER NOT NULL REFERENCES campaigns (id) ON DELETE CASCADE,
  first_candidate INTEGER NOT NULL CHECK (first_candidate >= 1),
  request_id TEXT CHECK (length(request_id) > 0),
  request_hash TEXT NOT NULL CHECK (length(request_hash) = 64),
  create_time INTEGER NOT NULL,
  PRIMARY KEY (campaign, first_candidate)
) STRICT, WITHOUT ROWID;
CREATE UNIQUE INDEX one_append_per_request ON campaign_appends (campaign, request_id);

-- Tiles are small beside their blobs, which are of kilobytes: only tiles are without row ids.
CREATE TABLE campaign_tiles (
  campaign INTEGER NOT NULL REFERENCES campaigns (id) ON DELETE CASCADE,
  first_row INTEGER NOT NULL CHECK (first_row >= 0),
  rows INTEGER NOT NULL CHECK (rows BETWEEN 1 AND 4096),
  PRIMARY KEY (campaign, first_row)
) STRICT, WITHOUT ROWID;
CREATE TRIGGER tiles_never_change BEFORE UPDATE ON campaign_tiles
BEGIN SELECT RAISE(ABORT, 'a tile never changes'); END;

CREATE TABLE campaign_blobs (
  campaign INTEGER NOT NULL REFERENCES campaigns (id) ON DELETE CASCADE,
  number INTEGER NOT NULL CHECK (number >= 0),
  first_row INTEGER NOT NULL,
  checksum INTEGER NOT NULL,
  data BLOB NOT NULL,
  UNIQUE (campaign, number, first_row)
) STRICT;

CREATE TABLE campaign_refusals (
  campaign INTEGER NOT NULL REFERENCES campaigns (id) ON DELETE CASCADE,
  number INTEGER NOT NULL CHECK (number >= 1),
  reason TEXT NOT NULL,
  message TEXT NOT NULL,
  PRIMARY KEY (campaign, number)
) STRICT, WITHOUT ROWID;

CREATE TABLE campaign_suspects (
  campaign INTEGER NOT NULL REFERENCES campaigns (id) ON DELETE CASCADE,
  first_row INTEGER NOT NULL CHECK (first_row >= 0),
  rows INTEGER NOT NULL CHECK (rows >= 1),
  is_begun INTEGER NOT NULL CHECK (is_begun IN (0, 1)),
  lost_attempts INTEGER NOT NULL CHECK (lost_attempts >= 0),
  PRIMARY KEY (campaign, first_row)
) STRICT, WITHOUT ROWID;

CREATE TABLE tokens (
  hash TEXT PRIMARY KEY CHECK (length(hash) = 64),
  name TEXT NOT NULL CHECK (length(name) BETWEEN 1 AND 63),
  scope INTEGER NOT NULL CHECK (scope BETWEEN 1 AND 3),
  projects TEXT NOT NULL,
  create_time INTEGER NOT NULL,
  expire_time INTEGER,
  revoke_time INTEGER,
  calls_per_second REAL CHECK (calls_per_second > 0),
  streams INTEGER CHECK (streams > 0),
  processor_hours REAL CHECK (processor_hours > 0)
) STRICT, WITHOUT ROWID;
CREATE INDEX tokens_by_name ON tokens (name);
CREATE TRIGGER tokens_stay BEFORE DELETE ON tokens
BEGIN SELECT RAISE(ABORT, 'a token is revoked, never removed'); END;
CREATE TRIGGER tokens_stay_revoked BEFORE UPDATE ON tokens
WHEN OLD.revoke_time IS NOT NULL
BEGIN SELECT RAISE(ABORT, 'a revoked token never changes'); END;

CREATE TABLE token_log (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  change INTEGER NOT NULL,
  acknowledged INTEGER NOT NULL,
  page_token_key BLOB NOT NULL CHECK (length(page_token_key) = 32)
) STRICT;
)sql";

}  // namespace tribodyn::server
