// Store: simulations, the changes of their states, their events, results and histories.
#include <SQLiteCpp/Transaction.h>

#include "server/storage/checksum.h"
#include "server/storage/event_rows.h"
#include "server/storage/resource_rows.h"
#include "server/storage/simulation_queries.h"
#include "server/storage/simulation_rows.h"
#include "server/storage/store_access.h"

namespace tribodyn::server {

AddOutcome Store::add_simulation(const NewSimulation& simulation, Microseconds now, bool may_wait,
                                 const CallLimits& limits) {
  AddOutcome added;
  if (!may_wait) {
    // A simulation that must wait is refused by a read, which waits for no commit.
    const bool needs_row =
        read(limits, [&](Connection& db) { return is_known_or_served(db, simulation); });
    if (!needs_row) return {AddOutcome::Kind::kNoPlace, 0};
  }
  write_together(limits,
                 [&](Connection& db) { added = insert_simulation(db, simulation, now, may_wait); });
  return added;
}

std::optional<StoredSimulation> Store::simulation(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_simulation(db, id); });
}

std::optional<StoredSimulation> Store::numbered_simulation(const std::string& project,
                                                           std::int64_t number,
                                                           const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_numbered_simulation(db, project, number); });
}

std::optional<StoredSimulation> Store::simulation_of_request(const std::string& project,
                                                             const std::string& request_id,
                                                             const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_simulation_of_request(db, project, request_id); });
}

Page<StoredSimulation> Store::simulations(const SimulationQuery& query, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_simulations(db, query); });
}

std::optional<StoredSimulation> Store::set_pinned(std::int64_t id, bool is_pinned,
                                                  const CallLimits& limits) {
  std::optional<StoredSimulation> out;
  write_together(limits, [&](Connection& db) {
    execute(db, "UPDATE simulations SET pinned = ? WHERE id = ?", is_pinned, id);
    out = query_simulation(db, id);
  });
  return out;
}

std::optional<StoredSimulation> Store::relabel_simulation(
    const StoredSimulation& present, const std::string& request,
    const std::vector<std::pair<std::string, std::string>>& labels, const CallLimits& limits) {
  std::optional<StoredSimulation> out;
  write_together(limits, [&](Connection& db) {
    out.reset();
    if (set_labels(db, present.id, present.request, request, labels)) {
      out = query_simulation(db, present.id);
    }
  });
  return out;
}

Store::Removal Store::remove_simulation(std::int64_t id, const std::optional<std::string>& request,
                                        const CallLimits& limits) {
  return write(limits, [&](Connection& db) {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    Prepared query(db, "SELECT state, pinned, request FROM simulations WHERE id = ?", id);
    if (!query.executeStep()) return Removal::kAbsent;
    if (query.getColumn(0).getInt() < static_cast<int>(StoredState::kSucceeded)) {
      return Removal::kUnfinished;
    }
    if (query.getColumn(1).getInt() != 0) return Removal::kPinned;
    if (request && bytes_of(query.getColumn(2)) != *request) return Removal::kChanged;
    query.reset();
    server::remove_simulation(db, id);
    transaction.commit();
    return Removal::kDone;
  });
}

std::optional<StoredEvent> Store::next_event(std::int64_t id, std::int64_t after_sequence,
                                             const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_next_event(db, id, after_sequence); });
}

std::optional<StoredEvent> Store::deletion(const std::string& project,
                                           std::int64_t simulation_number,
                                           const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_deletion(db, project, simulation_number); });
}

EventPage Store::events(const EventQuery& query, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_events(db, query); });
}

RecentEvents::Source Store::event_source(const std::string& project, const CallLimits& limits) {
  return {[this, &project, &limits](std::int64_t after) {
            return events({.project = project, .after = after}, limits);
          },
          [this, &project, &limits] { return event_range(project, limits).latest; },
          [this, &project, &limits](const std::vector<std::int64_t>& numbers) {
            return read(limits, [&](Connection& db) { return query_states(db, project, numbers); });
          }};
}

std::optional<EventPage> Store::recent_events(const std::string& project, std::int64_t after,
                                              const CallLimits& limits) {
  return recent_events_.after(project, after, event_source(project, limits));
}

RecentEvents::States Store::simulation_states(const std::string& project,
                                              const std::vector<std::int64_t>& numbers,
                                              const CallLimits& limits) {
  return recent_events_.states(project, numbers, event_source(project, limits));
}

EventRange Store::event_range(const std::string& project, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_event_range(db, project); });
}

std::optional<StoredEvent> Store::mark_running(std::int64_t id, Microseconds now,
                                               const ResultKey& key, const LeaseTerms& lease) {
  return change_simulation(
      {}, [&](Connection& db) { return start_simulation(db, id, now, key, lease); });
}

bool Store::extend_lease(std::int64_t id, int attempt, Microseconds expire_time) {
  bool out = false;
  write_together({},
                 [&](Connection& db) { out = server::extend_lease(db, id, attempt, expire_time); });
  return out;
}

std::optional<StoredEvent> Store::mark_lost(std::int64_t id, int attempt, Microseconds now,
                                            const std::string& reason) {
  return change_simulation(
      {}, [&](Connection& db) { return lose_attempt(db, id, attempt, now, reason); });
}

std::optional<StoredEvent> Store::mark_queued(std::int64_t id, Microseconds now,
                                              const std::string& reason,
                                              std::optional<int> attempt) {
  return change_simulation({}, [&](Connection& db) {
    return change_state(
        db,
        {.id = id, .to = StoredState::kQueued, .time = now, .reason = reason, .attempt = attempt});
  });
}

std::optional<StoredEvent> Store::mark_cancelled(std::int64_t id, Microseconds now,
                                                 const CallLimits& limits) {
  return change_simulation(limits, [&](Connection& db) {
    return change_state(db, {.id = id, .to = StoredState::kCancelled, .time = now});
  });
}

std::optional<StoredEvent> Store::mark_failed(std::int64_t id, Microseconds now,
                                              const std::string& reason, const std::string& message,
                                              std::optional<int> attempt) {
  return change_simulation({}, [&](Connection& db) {
    return change_state(db, {.id = id,
                             .to = StoredState::kFailed,
                             .time = now,
                             .error_reason = reason,
                             .error_message = message,
                             .attempt = attempt});
  });
}

std::optional<StoredEvent> Store::mark_succeeded(std::int64_t id, Microseconds now,
                                                 const NewResult& result,
                                                 std::optional<int> attempt) {
  // Compresses before the transaction, so that other writers do not wait.
  std::vector<CompressedColumn> history;
  for (const StoredColumn& each : result.history) history.push_back(compress(each));
  return change_simulation(
      {}, [&](Connection& db) { return finish_simulation(db, id, now, result, attempt, history); });
}

std::vector<UnfinishedSimulation> Store::requeue_unfinished(Microseconds now) {
  return write({}, [&](Connection& db) {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    std::vector<UnfinishedSimulation> waiting = requeue_lost(db, now);
    transaction.commit();
    return waiting;
  });
}

std::optional<std::string> Store::result(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_result(db, id); });
}

std::optional<StoredHistory> Store::stored_history(const std::string& project, std::int64_t number,
                                                   const CallLimits& limits) {
  return read(limits, [&](Connection& db) -> std::optional<StoredHistory> {
    auto simulation = query_numbered_simulation(db, project, number);
    if (!simulation) return std::nullopt;
    StoredHistory out{*std::move(simulation)};
    if (out.simulation.state != StoredState::kSucceeded) return out;
    out.result = query_result(db, out.simulation.id).value_or("");
    out.shape = query_history_shape_of(db, out.simulation.id);
    return out;
  });
}

HistoryShape Store::history_shape(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_history_shape_of(db, id); });
}

bool Store::read_history(std::int64_t column, int level, std::int64_t start,
                         std::span<double> values, const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_history(db, column, level, start, values); });
}

}  // namespace tribodyn::server
