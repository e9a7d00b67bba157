#include "server/storage/event_rows.h"

#include <algorithm>
#include <string>

#include "server/storage/list_conditions.h"
#include "server/storage/resource_rows.h"
#include "server/storage/times.h"

namespace tribodyn::server {
namespace {

/// Deletions are forgotten so many at a time.
constexpr int kForgottenAtOnce = 1000;

/// The number of a removed simulation stands in its deletion, of others in their row.
constexpr char kEventColumns[] =
    "SELECT e.number, e.simulation, e.sequence, e.time, e.state, e.attempt, e.reason, "
    "e.project, coalesce(e.simulation_number, s.number) "
    "FROM events e LEFT JOIN simulations s ON s.id = e.simulation ";

StoredEvent stored_event(const SQLite::Statement& query) {
  return {.number = query.getColumn(0).getInt64(),
          .simulation = query.getColumn(1).getInt64(),
          .sequence = query.getColumn(2).getInt64(),
          .time = query.getColumn(3).getInt64(),
          .state = static_cast<StoredState>(query.getColumn(4).getInt()),
          .attempt = query.getColumn(5).getInt(),
          .reason = query.getColumn(6).getString(),
          .project = query.getColumn(7).getString(),
          .simulation_number = query.getColumn(8).getInt64()};
}

void forget_oldest_deletions(Connection& db, const std::string& project) {
  const std::string count = std::to_string(kForgottenAtOnce);
  execute(db,
          "UPDATE projects SET deletions = deletions - " + count +
              ", forgotten_event = (SELECT number FROM events WHERE project = ?1 AND "
              "state = 0 ORDER BY number LIMIT 1 OFFSET " +
              count + " - 1) WHERE name = ?1",
          project);
  execute(db,
          "DELETE FROM events WHERE project = ?1 AND state = 0 AND number <= "
          "(SELECT forgotten_event FROM projects WHERE name = ?1)",
          project);
}

/// Sets project and number of an event of a simulation: the next number of its project.
void take_event_number(Connection& db, StoredEvent& event) {
  Prepared next(db,
                "UPDATE projects SET last_event = last_event + 1 WHERE name = "
                "(SELECT project FROM simulations WHERE id = ?) RETURNING name, last_event",
                event.simulation);
  if (!next.executeStep()) return;  // without its simulation a trigger refuses the event
  event.project = next.getColumn(0).getString();
  event.number = next.getColumn(1).getInt64();
  next.executeStep();  // to its end: only then is it done
}

/// "[1,2,3]", for json_each().
std::string json_array(const std::vector<std::int64_t>& numbers) {
  std::string out = "[";
  for (const std::int64_t each : numbers) out += std::to_string(each) + ",";
  out.back() = ']';
  return out;
}

void read_events(SQLite::Statement& query, EventPage& page) {
  while (query.executeStep()) page.events.push_back(stored_event(query));
  page.more = page.events.size() == kEventPage;
  if (page.more) page.through = page.events.back().number;
}

}  // namespace

void insert_event(Connection& db, StoredEvent& event) {
  take_event_number(db, event);
  std::optional<std::int64_t> deleted;
  if (event.state == StoredState::kDeleted) deleted = event.simulation_number;
  execute(db,
          "INSERT INTO events (simulation, sequence, time, state, attempt, reason, "
          "project, number, simulation_number) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
          event.simulation, event.sequence, event.time, event.state, event.attempt, event.reason,
          event.project, event.number, deleted);
}

void insert_deletion(Connection& db, std::int64_t simulation) {
  Prepared last(
      db, std::string(kEventColumns) + "WHERE e.simulation = ? ORDER BY e.sequence DESC LIMIT 1",
      simulation);
  if (!last.executeStep()) return;
  StoredEvent deletion = stored_event(last);
  last.reset();
  deletion.sequence += 1;
  deletion.time = system_time();
  deletion.state = StoredState::kDeleted;
  deletion.reason.clear();
  insert_event(db, deletion);
  execute(db, "DELETE FROM events WHERE simulation = ? AND state <> 0", simulation);
  const auto deletions =
      Prepared(db,
               "UPDATE projects SET deletions = deletions + 1 WHERE name = ? RETURNING deletions",
               deletion.project)
          .returned();
  if (deletions >= kKeptDeletions + kForgottenAtOnce) {
    forget_oldest_deletions(db, deletion.project);
  }
}

std::optional<StoredEvent> query_next_event(Connection& db, std::int64_t simulation,
                                            std::int64_t after_sequence) {
  Prepared query(db,
                 std::string(kEventColumns) +
                     "WHERE e.simulation = ? AND e.sequence > ? ORDER BY e.sequence LIMIT 1",
                 simulation, after_sequence);
  return query.first(stored_event);
}

std::optional<StoredEvent> query_deletion(Connection& db, const std::string& project,
                                          std::int64_t simulation_number) {
  Prepared query(db,
                 std::string(kEventColumns) +
                     "WHERE e.state = 0 AND e.project = ? AND e.simulation_number = ?",
                 project, simulation_number);
  return query.first(stored_event);
}

EventPage query_events(Connection& db, const EventQuery& query) {
  EventPage page;
  const std::int64_t latest = query_event_range(db, query.project).latest;
  if (!query.simulations.empty()) {
    Prepared events(db,
                    std::string(kEventColumns) +
                        "WHERE e.simulation IN (SELECT value FROM json_each(?)) "
                        "AND e.number > ? ORDER BY e.number LIMIT ?",
                    json_array(query.simulations), query.after, kEventPage);
    read_events(events, page);
    if (!page.more) page.through = std::max(query.after, latest);
    if (!page.events.empty()) page.through = std::max(page.through, page.events.back().number);
    return page;
  }
  page.through = std::min(latest, query.after + kEventWindow);
  const Condition condition = list_condition(db, "simulations", query.project, query.restrictions);
  SQLite::Statement events(db, std::string(kEventColumns) +
                                   "WHERE e.project = ? AND e.number > ? AND e.number <= ? AND "
                                   "(e.state = 0 OR EXISTS "
                                   "(SELECT 1 FROM simulations WHERE id = e.simulation AND " +
                                   condition.sql + ")) ORDER BY e.number LIMIT ?");
  std::vector<PropertyValue> values{query.project, query.after, page.through};
  values.insert(values.end(), condition.values.begin(), condition.values.end());
  values.emplace_back(std::int64_t{kEventPage});
  bind_values(events, values);
  const std::int64_t window_end = page.through;
  read_events(events, page);
  page.more = page.more || window_end < latest;
  return page;
}

std::vector<std::optional<SimulationState>> query_states(Connection& db, const std::string& project,
                                                         const std::vector<std::int64_t>& numbers) {
  std::vector<std::optional<SimulationState>> out(numbers.size());
  if (numbers.empty()) return out;
  Prepared query(db,
                 "SELECT asked.key, s.id, s.state, s.attempt, s.sequence, e.number "
                 "FROM json_each(?) asked "
                 "JOIN simulations s ON s.project = ? AND s.number = asked.value "
                 "JOIN events e ON e.simulation = s.id AND e.sequence = s.sequence",
                 json_array(numbers), project);
  while (query.executeStep()) {
    out[static_cast<std::size_t>(query.getColumn(0).getInt64())] =
        SimulationState{.id = query.getColumn(1).getInt64(),
                        .state = static_cast<StoredState>(query.getColumn(2).getInt()),
                        .attempt = query.getColumn(3).getInt(),
                        .sequence = query.getColumn(4).getInt64(),
                        .event_number = query.getColumn(5).getInt64()};
  }
  return out;
}

EventRange query_event_range(Connection& db, const std::string& project) {
  Prepared query(db, "SELECT last_event, forgotten_event FROM projects WHERE name = ?", project);
  if (!query.executeStep()) return {};
  return {query.getColumn(0).getInt64(), query.getColumn(1).getInt64()};
}

}  // namespace tribodyn::server
