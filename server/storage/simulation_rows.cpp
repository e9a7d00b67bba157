#include "server/storage/simulation_rows.h"

#include <algorithm>

#include "server/storage/checksum.h"
#include "server/storage/event_rows.h"
#include "server/storage/history_rows.h"
#include "server/storage/resource_rows.h"
#include "server/storage/store_error.h"
#include "server/support/sha256.h"

namespace tribodyn::server {

std::string simulation_columns(RevisionColumns form) {
  std::string out =
      "SELECT id, state, attempt, sequence, create_time, start_time, end_time, deadline_time, "
      "request, request_hash, is_forced, cache_hit, input_hash, error_reason, error_message, ";
  out +=
      form == RevisionColumns::kRows
          ? "lubricant, gear_set, surface, vehicle, "
          : "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = lubricant), "
            "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = gear_set), "
            "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = surface), "
            "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = vehicle), ";
  return out +
         "request_id, pinned, client, cost_seconds, principal, scheduling_class, project, number, "
         "request_checksum FROM simulations ";
}

namespace {

std::optional<Microseconds> time_of(const SQLite::Column& column) {
  if (column.isNull()) return std::nullopt;
  return column.getInt64();
}

/// Row of the result with this key in a project: projects share no results, as a cache hit would
/// tell one project what another has computed.
std::optional<std::int64_t> result_row(Connection& db, const std::string& project,
                                       const ResultKey& key) {
  Prepared query(db,
                 "SELECT id FROM results "
                 "WHERE project = ? AND input_hash = ? AND model_version = ? AND platform = ?",
                 project, key.input_hash, key.model_version, key.platform);
  return query.first([](SQLite::Statement& row) { return row.getColumn(0).getInt64(); });
}

/// Project of a simulation. Throws SQLite::Exception if the simulation does not exist.
std::string project_of(Connection& db, std::int64_t id) {
  Prepared query(db, "SELECT project FROM simulations WHERE id = ?", id);
  if (!query.executeStep()) throw SQLite::Exception("no such simulation");
  return query.getColumn(0).getString();
}

/// Takes the next number of a project. Numbers of removed simulations are not given again.
std::int64_t next_number(Connection& db, const std::string& project) {
  const auto number = Prepared(db,
                               "UPDATE projects SET last_number = last_number + 1 WHERE name = ? "
                               "RETURNING last_number",
                               project)
                          .returned();
  if (!number) throw SQLite::Exception("no such project");
  return *number;
}

/// Returns the simulation that an earlier request with the same request_id added to the
/// same project.
std::optional<AddOutcome> repeated_request(Connection& db, const NewSimulation& simulation) {
  if (simulation.request_id.empty()) return std::nullopt;
  auto stored = query_simulation_of_request(db, simulation.project, simulation.request_id);
  if (!stored) return std::nullopt;
  const bool is_same = stored->request_hash == simulation.request_hash;
  return AddOutcome{is_same ? AddOutcome::Kind::kRepeated : AddOutcome::Kind::kRequestIdTaken,
                    stored->id, std::move(*stored)};
}

void insert_labels(Connection& db, std::int64_t id,
                   const std::vector<std::pair<std::string, std::string>>& labels) {
  for (const auto& [key, value] : labels) {
    execute(db, "INSERT INTO simulation_labels VALUES (?, ?, ?)", key, value, id);
  }
}

/// Inserts a QUEUED simulation and its first event. The statement itself finds the rows of the
/// revisions: a read before it would be one more, and one outside the transaction could be stale.
std::int64_t insert_row(Connection& db, const NewSimulation& simulation, std::int64_t number,
                        Microseconds now) {
  std::optional<std::int64_t> ledger;
  if (!simulation.ledger.empty()) ledger = ledger_row(db, simulation.ledger);
  const auto names = simulation.revisions.all();
  std::vector<RevisionRow> revisions;
  for (const std::string* name : names) {
    revisions.push_back(revision_row(simulation.project, *name));
  }
  Prepared insert(db,
                  "INSERT INTO simulations (state, sequence, create_time, deadline_time, request, "
                  "request_checksum, request_id, request_hash, is_forced, input_hash, ledger, "
                  "client, cost_seconds, principal, "
                  "scheduling_class, lubricant, gear_set, surface, vehicle, project, number) "
                  "VALUES (1, 1, ?, ?, ?, ?, nullif(?, ''), ?, ?, ?, ?, ?, ?, ?, ?, "
                  "(SELECT revision_id FROM revision_names WHERE name = ? AND revision = ?), "
                  "(SELECT revision_id FROM revision_names WHERE name = ? AND revision = ?), "
                  "(SELECT revision_id FROM revision_names WHERE name = ? AND revision = ?), "
                  "(SELECT revision_id FROM revision_names WHERE name = ? AND revision = ?), ?, ?) "
                  "RETURNING id, lubricant, gear_set, surface, vehicle",
                  now, simulation.deadline_time, Blob{simulation.request},
                  checksum(simulation.request), simulation.request_id, simulation.request_hash,
                  simulation.is_forced, simulation.key.input_hash, ledger, simulation.client,
                  simulation.cost_seconds, simulation.principal, simulation.scheduling_class,
                  revisions[0].name, revisions[0].number, revisions[1].name, revisions[1].number,
                  revisions[2].name, revisions[2].number, revisions[3].name, revisions[3].number,
                  simulation.project, number);
  insert.executeStep();
  const std::int64_t id = insert.getColumn(0).getInt64();
  for (int i = 0; i < 4; ++i) {
    if (!names[static_cast<std::size_t>(i)]->empty() && insert.getColumn(1 + i).isNull()) {
      throw SQLite::Exception("no such revision");
    }
  }
  insert.executeStep();  // to its end: only then is it done
  insert_labels(db, id, simulation.labels);
  StoredEvent first{.simulation = id, .sequence = 1, .time = now, .reason = ""};
  insert_event(db, first);
  return id;
}

/// Returns the row that insert_row() has inserted. Reads nothing: a read after the commit could
/// fail or come too late, and the client would be told that nothing has changed.
StoredSimulation inserted_simulation(const NewSimulation& simulation, std::int64_t id,
                                     std::int64_t number, Microseconds now) {
  StoredSimulation out;
  out.id = id;
  out.project = simulation.project;
  out.number = number;
  out.sequence = 1;
  out.create_time = now;
  out.deadline_time = simulation.deadline_time;
  out.request = simulation.request;
  out.request_id = simulation.request_id;
  out.request_hash = simulation.request_hash;
  out.is_forced = simulation.is_forced;
  out.client = simulation.client;
  out.cost_seconds = simulation.cost_seconds;
  out.principal = simulation.principal;
  out.scheduling_class = simulation.scheduling_class;
  out.input_hash = simulation.key.input_hash;
  out.revisions = simulation.revisions;
  return out;
}

/// Bytes that go when a result goes.
std::int64_t size_of(const NewResult& result, const std::vector<CompressedColumn>& history) {
  std::size_t bytes = result.body.size();
  for (const CompressedColumn& column : history) {
    for (const std::vector<std::string>& level : column.levels) {
      for (const std::string& block : level) bytes += block.size();
    }
  }
  return static_cast<std::int64_t>(bytes);
}

void insert_history(Connection& db, std::int64_t result,
                    const std::vector<CompressedColumn>& history) {
  for (std::size_t i = 0; i < history.size(); ++i) {
    insert_history_column(db, result, static_cast<std::int64_t>(i), history[i]);
  }
}

std::int64_t insert_result(Connection& db, const std::string& project, const NewResult& result,
                           const std::vector<CompressedColumn>& history, Microseconds now) {
  execute(db,
          "INSERT INTO results (input_hash, model_version, platform, create_time, body, "
          "checksum, stored_bytes, project) VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
          result.key.input_hash, result.key.model_version, result.key.platform, now,
          Blob{result.body}, checksum(result.body), size_of(result, history), project);
  const std::int64_t row = db.getLastInsertRowid();
  insert_history(db, row, history);
  return row;
}

/// Whether a stored result and its history are what was written.
bool is_whole_result(Connection& db, std::int64_t row) {
  Prepared body(db, "SELECT body, checksum FROM results WHERE id = ?", row);
  if (!body.executeStep()) return false;
  if (checksum(bytes_of(body.getColumn(0))) != body.getColumn(1).getInt64()) return false;
  const std::vector<std::int64_t> columns = query_history_shape(db, row).columns;
  return std::all_of(columns.begin(), columns.end(),
                     [&](std::int64_t column) { return is_whole_column(db, column); });
}

/// Writes a result in the place of one that is damaged, for all simulations that have it.
void repair_result(Connection& db, std::int64_t row, const NewResult& result,
                   const std::vector<CompressedColumn>& history) {
  execute(db, "UPDATE results SET body = ?2, checksum = ?3, stored_bytes = ?4 WHERE id = ?1", row,
          Blob{result.body}, checksum(result.body), size_of(result, history));
  execute(db, "DELETE FROM history_columns WHERE result = ?", row);
  insert_history(db, row, history);
}

/// Of a simulation that came to another result than equal inputs have.
std::optional<StoredEvent> not_reproduced(Connection& db, std::int64_t id, Microseconds now,
                                          const ResultKey& key, std::optional<int> attempt) {
  return change_state(db, {.id = id,
                           .to = StoredState::kFailed,
                           .time = now,
                           .from = StoredState::kRunning,
                           .error_reason = "RESULT_NOT_REPRODUCED",
                           .error_message = "equal inputs have another result, of model " +
                                            key.model_version + " on " + key.platform,
                           .attempt = attempt});
}

bool is_running(Connection& db, std::int64_t id) {
  Prepared query(db, "SELECT 1 FROM simulations WHERE id = ? AND state = 2", id);
  return query.executeStep();
}

/// Bit for bit, histories too.
bool is_same_result(Connection& db, std::int64_t row, const NewResult& result) try {
  Prepared body(db, "SELECT 1 FROM results WHERE id = ? AND body = ? AND checksum = ?", row,
                Blob{result.body}, checksum(result.body));
  if (!body.executeStep()) return false;
  const HistoryShape shape = query_history_shape(db, row);
  if (shape.names.size() != result.history.size()) return false;
  for (std::size_t i = 0; i < result.history.size(); ++i) {
    if (shape.names[i] != result.history[i].name ||
        !holds_column(db, shape.columns[i], result.history[i].values)) {
      return false;
    }
  }
  return true;
} catch (const StoreError& damage) {
  if (damage.kind() != StoreError::Kind::kDataLoss) throw;
  return false;
}

}  // namespace

bool set_labels(Connection& db, std::int64_t id, const std::string& before,
                const std::string& request,
                const std::vector<std::pair<std::string, std::string>>& labels) {
  const int changed = execute(
      db, "UPDATE simulations SET request = ?, request_checksum = ? WHERE id = ? AND request = ?",
      Blob{request}, checksum(request), id, Blob{before});
  if (changed == 0) return false;
  execute(db, "DELETE FROM simulation_labels WHERE simulation = ?", id);
  insert_labels(db, id, labels);
  return true;
}

std::int64_t ledger_row(Connection& db, const std::string& body) {
  const std::string hash = sha256(body);
  Prepared find(db, "SELECT id, body FROM ledgers WHERE content_hash = ?", hash);
  if (!find.executeStep()) {
    execute(db, "INSERT INTO ledgers (content_hash, body) VALUES (?, ?)", hash, Blob{body});
    return db.getLastInsertRowid();
  }
  const std::int64_t row = find.getColumn(0).getInt64();
  if (bytes_of(find.getColumn(1)) != body) {  // damaged
    execute(db, "UPDATE ledgers SET body = ? WHERE id = ?", Blob{body}, row);
  }
  return row;
}

StoredSimulation stored_simulation(const SQLite::Statement& query, RevisionNames* names) {
  const auto revision = [&](int column) {
    const SQLite::Column value = query.getColumn(column);
    return names != nullptr ? names->of(value) : relative_name(value.getString());
  };
  StoredSimulation out;
  out.id = query.getColumn(0).getInt64();
  out.state = static_cast<StoredState>(query.getColumn(1).getInt());
  out.attempt = query.getColumn(2).getInt();
  out.sequence = query.getColumn(3).getInt64();
  out.create_time = query.getColumn(4).getInt64();
  out.start_time = time_of(query.getColumn(5));
  out.end_time = time_of(query.getColumn(6));
  out.deadline_time = time_of(query.getColumn(7));
  out.request = query.getColumn(kRequestColumn).getString();
  out.request_hash = query.getColumn(9).getString();
  out.is_forced = query.getColumn(10).getInt() != 0;
  out.cache_hit = query.getColumn(11).getInt() != 0;
  out.input_hash = query.getColumn(12).getString();
  out.error_reason = query.getColumn(13).getString();
  out.error_message = query.getColumn(14).getString();
  out.revisions.lubricant = revision(15);
  out.revisions.gear_set = revision(16);
  out.revisions.surface = revision(17);
  out.revisions.vehicle = revision(18);
  out.request_id = query.getColumn(19).getString();
  out.is_pinned = query.getColumn(20).getInt() != 0;
  out.client = query.getColumn(21).getString();
  out.cost_seconds = query.getColumn(22).getDouble();
  out.principal = query.getColumn(23).getString();
  out.scheduling_class = query.getColumn(24).getInt();
  out.project = query.getColumn(25).getString();
  out.number = query.getColumn(26).getInt64();
  require_undamaged(out.request, query.getColumn(27).getInt64(), "the stored request of ",
                    simulation_name(out.project, out.number));
  return out;
}

/// Returns the only simulation that a condition can select.
template <class... Values>
std::optional<StoredSimulation> find_simulation(Connection& db, const char* where,
                                                const Values&... values) {
  return Prepared(db, simulation_columns(RevisionColumns::kNames) + where, values...)
      .first([](const SQLite::Statement& row) { return stored_simulation(row, nullptr); });
}

std::optional<StoredSimulation> query_simulation(Connection& db, std::int64_t id) {
  return find_simulation(db, "WHERE id = ?", id);
}

std::optional<StoredSimulation> query_numbered_simulation(Connection& db,
                                                          const std::string& project,
                                                          std::int64_t number) {
  return find_simulation(db, "WHERE project = ? AND number = ?", project, number);
}

std::optional<StoredSimulation> query_simulation_of_request(Connection& db,
                                                            const std::string& project,
                                                            const std::string& request_id) {
  return find_simulation(db, "WHERE project = ? AND request_id = ?", project, request_id);
}

bool is_known_or_served(Connection& db, const NewSimulation& simulation) {
  if (!simulation.request_id.empty() &&
      query_simulation_of_request(db, simulation.project, simulation.request_id)) {
    return true;
  }
  return !simulation.is_forced && result_row(db, simulation.project, simulation.key);
}

AddOutcome insert_simulation(Connection& db, const NewSimulation& simulation, Microseconds now,
                             bool may_wait) {
  if (auto repeated = repeated_request(db, simulation)) return std::move(*repeated);
  std::optional<std::int64_t> result;
  if (!simulation.is_forced) result = result_row(db, simulation.project, simulation.key);
  if (!result && !may_wait) return {AddOutcome::Kind::kNoPlace, 0};
  const std::int64_t number = next_number(db, simulation.project);
  const std::int64_t id = insert_row(db, simulation, number, now);
  AddOutcome added{AddOutcome::Kind::kQueued, id, inserted_simulation(simulation, id, number, now)};
  if (!result) return added;
  const auto event = change_state(
      db,
      {.id = id, .to = StoredState::kSucceeded, .time = now, .result = result, .cache_hit = true});
  added.kind = AddOutcome::Kind::kServed;
  added.stored.state = event->state;
  added.stored.sequence = event->sequence;
  added.stored.end_time = event->time;
  added.stored.cache_hit = true;
  return added;
}

std::optional<StoredEvent> change_state(Connection& db, const StateChange& change) {
  // Only an update that ends a simulation names the result and the other columns of an end: SQLite
  // rewrites the entry of every index of which an update names a column, even if its value stays.
  static const auto update_that_sets = [](const std::string& more) {
    return "UPDATE simulations SET state = ?2, sequence = sequence + 1, "
           "attempt = attempt + (?2 = 1), lost_attempts = lost_attempts + ?9, "
           "start_time = CASE ?2 WHEN 1 THEN NULL WHEN 2 THEN ?3 ELSE start_time END, " +
           more +
           "lease_worker = nullif(?11, ''), lease_expire_time = CASE WHEN ?11 <> '' THEN ?12 END "
           "WHERE id = ?1 AND state = coalesce(?4, state) AND state <= 2 AND state <> ?2 "
           "AND attempt = coalesce(?10, attempt) RETURNING sequence, attempt, start_time";
  };
  static const std::string kUpdate = update_that_sets("");
  static const std::string kEndingUpdate = update_that_sets(
      "end_time = ?3, error_reason = nullif(?5, ''), error_message = nullif(?6, ''), "
      "result = ?7, cache_hit = ?8, ");
  const LeaseTerms lease = change.lease.value_or(LeaseTerms{.worker = ""});
  Prepared update(db, has_ended(change.to) ? kEndingUpdate : kUpdate, change.id, change.to,
                  change.time, change.from, change.error_reason, change.error_message,
                  change.result, change.cache_hit, change.attempt_is_lost, change.attempt,
                  lease.worker, lease.expire_time);
  if (!update.executeStep()) return std::nullopt;
  StoredEvent event{.simulation = change.id,
                    .sequence = update.getColumn(0).getInt64(),
                    .time = change.time,
                    .state = change.to,
                    .attempt = update.getColumn(1).getInt(),
                    .reason = change.reason};
  event.start_time = time_of(update.getColumn(2));
  update.executeStep();  // to its end: only then is it done
  insert_event(db, event);
  return event;
}

std::optional<StoredEvent> start_simulation(Connection& db, std::int64_t id, Microseconds now,
                                            const ResultKey& key, const LeaseTerms& lease) {
  Prepared query(
      db, "SELECT is_forced, project, input_hash FROM simulations WHERE id = ? AND state = 1", id);
  if (!query.executeStep()) return std::nullopt;
  const bool is_forced = query.getColumn(0).getInt() != 0;
  const std::string project = query.getColumn(1).getString();
  if (query.getColumn(2).getString() != key.input_hash) {
    execute(db, "UPDATE simulations SET input_hash = ? WHERE id = ?", key.input_hash, id);
  }
  std::optional<std::int64_t> result;
  if (!is_forced) result = result_row(db, project, key);
  StateChange change{.id = id,
                     .to = result ? StoredState::kSucceeded : StoredState::kRunning,
                     .time = now,
                     .from = StoredState::kQueued,
                     .result = result,
                     .cache_hit = result.has_value()};
  if (!result) change.lease = lease;
  return change_state(db, change);
}

std::optional<std::string> query_result(Connection& db, std::int64_t id) {
  Prepared query(db,
                 "SELECT r.body, r.checksum, l.body, l.content_hash, s.project, s.number "
                 "FROM simulations s "
                 "JOIN results r ON r.id = s.result "
                 "LEFT JOIN ledgers l ON l.id = s.ledger WHERE s.id = ?",
                 id);
  if (!query.executeStep()) return std::nullopt;
  const std::string_view result = bytes_of(query.getColumn(0));
  const std::string_view ledger = bytes_of(query.getColumn(2));
  const bool has_ledger = !query.getColumn(3).isNull();
  if (checksum(result) != query.getColumn(1).getInt64() ||
      (has_ledger && sha256(ledger) != query.getColumn(3).getString())) {
    throw StoreError(
        StoreError::Kind::kDataLoss,
        "the stored result of " +
            simulation_name(query.getColumn(4).getString(), query.getColumn(5).getInt64()) +
            " is damaged");
  }
  // The bytes of two messages in a row are those of both merged.
  return std::string(result).append(ledger);
}

std::optional<StoredEvent> finish_simulation(Connection& db, std::int64_t id, Microseconds now,
                                             const NewResult& result, std::optional<int> attempt,
                                             const std::vector<CompressedColumn>& history) {
  // Before anything is written: what is rolled back may already be in the write-ahead log, and a
  // purge may have erased what the result rests on.
  if (!is_running(db, id)) return std::nullopt;
  const std::string project = project_of(db, id);
  std::optional<std::int64_t> row = result_row(db, project, result.key);
  if (row && !is_same_result(db, *row, result)) {
    if (is_whole_result(db, *row)) return not_reproduced(db, id, now, result.key, attempt);
    repair_result(db, *row, result, history);
  }
  if (!row) row = insert_result(db, project, result, history, now);
  return change_state(db, {.id = id,
                           .to = StoredState::kSucceeded,
                           .time = now,
                           .from = StoredState::kRunning,
                           .result = row,
                           .attempt = attempt});
}

std::optional<StoredEvent> lose_attempt(Connection& db, std::int64_t id, int attempt,
                                        Microseconds now, const std::string& reason) {
  Prepared find(db, "SELECT lost_attempts FROM simulations WHERE id = ?", id);
  if (!find.executeStep()) return std::nullopt;
  const int lost = find.getColumn(0).getInt() + 1;
  StateChange change{.id = id, .to = StoredState::kQueued, .time = now, .reason = reason};
  change.from = StoredState::kRunning;
  change.attempt = attempt;
  change.attempt_is_lost = true;
  if (lost >= kMaximumLostAttempts) {
    change.to = StoredState::kFailed;
    change.error_reason = "WORKER_LOST";
    change.error_message = "the process that computed it was lost " +
                           std::to_string(kMaximumLostAttempts) + " times; it is not tried again";
  }
  return change_state(db, change);
}

bool extend_lease(Connection& db, std::int64_t id, int attempt, Microseconds expire_time) {
  return execute(db,
                 "UPDATE simulations SET lease_expire_time = ? "
                 "WHERE id = ? AND state = 2 AND attempt = ?",
                 expire_time, id, attempt) > 0;
}

std::vector<UnfinishedSimulation> requeue_lost(Connection& db, Microseconds now) {
  std::vector<std::pair<std::int64_t, int>> lost;
  Prepared find(db,
                "SELECT id, attempt FROM simulations WHERE state IN (1, 2) AND state = 2 AND "
                "(lease_worker = ? OR lease_expire_time <= ?)",
                LeaseTerms::kLocalWorker, now);
  while (find.executeStep()) {
    lost.emplace_back(find.getColumn(0).getInt64(), find.getColumn(1).getInt());
  }
  for (const auto& [id, attempt] : lost) lose_attempt(db, id, attempt, now, "SERVER_LOST");
  std::vector<UnfinishedSimulation> waiting;
  Prepared query(db,
                 "SELECT id, attempt, lost_attempts, deadline_time, principal, scheduling_class, "
                 "cost_seconds, lease_worker, lease_expire_time FROM simulations "
                 "WHERE state IN (1, 2) ORDER BY id");
  while (query.executeStep()) {
    UnfinishedSimulation each{.id = query.getColumn(0).getInt64(),
                              .attempt = query.getColumn(1).getInt(),
                              .lost_attempts = query.getColumn(2).getInt(),
                              .deadline_time = time_of(query.getColumn(3)),
                              .principal = query.getColumn(4).getString(),
                              .scheduling_class = query.getColumn(5).getInt(),
                              .cost_seconds = query.getColumn(6).getDouble()};
    if (!query.getColumn(7).isNull()) {
      each.lease = LeaseTerms{query.getColumn(7).getString(), query.getColumn(8).getInt64()};
    }
    waiting.push_back(std::move(each));
  }
  return waiting;
}

}  // namespace tribodyn::server
