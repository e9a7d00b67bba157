#include "server/storage/event_rows.h"

#include <algorithm>
#include <string>

#include "server/storage/resource_rows.h"
#include "server/storage/simulation_queries.h"
#include "server/storage/times.h"

namespace tribodyn::server {
namespace {

/// Deletions are forgotten so many at a time.
constexpr int kForgottenAtOnce = 1000;

/// Project and number of a removed simulation stand in its deletion, of others in their row.
constexpr char kEventColumns[] =
    "SELECT e.number, e.simulation, e.sequence, e.time, e.state, e.attempt, e.reason, "
    "coalesce(e.project, s.project), coalesce(e.simulation_number, s.number) "
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

void forget_oldest_deletions(Connection& db) {
  db.exec(
      "UPDATE event_log SET deletions = deletions - " + std::to_string(kForgottenAtOnce) +
      ", forgotten = (SELECT number FROM events WHERE state = 0 ORDER BY number LIMIT 1 OFFSET " +
      std::to_string(kForgottenAtOnce - 1) + ")");
  db.exec("DELETE FROM events WHERE state = 0 AND number <= (SELECT forgotten FROM event_log)");
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
  Prepared insert(db,
                  "INSERT INTO events (simulation, sequence, time, state, attempt, reason, "
                  "project, simulation_number) VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, event.simulation);
  insert.bind(2, event.sequence);
  insert.bind(3, event.time);
  insert.bind(4, static_cast<int>(event.state));
  insert.bind(5, event.attempt);
  insert.bind(6, event.reason);
  if (event.state == StoredState::kDeleted) {
    insert.bind(7, event.project);
    insert.bind(8, event.simulation_number);
  }
  insert.exec();
  event.number = db.getLastInsertRowid();
}

void insert_deletion(Connection& db, std::int64_t simulation) {
  Prepared last(
      db, std::string(kEventColumns) + "WHERE e.simulation = ? ORDER BY e.sequence DESC LIMIT 1");
  last.bind(1, simulation);
  if (!last.executeStep()) return;
  StoredEvent deletion = stored_event(last);
  last.reset();
  deletion.sequence += 1;
  deletion.time = system_time();
  deletion.state = StoredState::kDeleted;
  deletion.reason.clear();
  insert_event(db, deletion);
  Prepared remove(db, "DELETE FROM events WHERE simulation = ? AND state <> 0");
  remove.bind(1, simulation);
  remove.exec();
  Prepared count(db, "UPDATE event_log SET deletions = deletions + 1 RETURNING deletions");
  count.executeStep();
  const int deletions = count.getColumn(0).getInt();
  count.executeStep();
  if (deletions >= kKeptDeletions + kForgottenAtOnce) forget_oldest_deletions(db);
}

std::optional<StoredEvent> query_next_event(Connection& db, std::int64_t simulation,
                                            std::int64_t after_sequence) {
  Prepared query(db, std::string(kEventColumns) +
                         "WHERE e.simulation = ? AND e.sequence > ? ORDER BY e.sequence LIMIT 1");
  query.bind(1, simulation);
  query.bind(2, after_sequence);
  if (!query.executeStep()) return std::nullopt;
  return stored_event(query);
}

std::optional<StoredEvent> query_deletion(Connection& db, const std::string& project,
                                          std::int64_t simulation_number) {
  Prepared query(db, std::string(kEventColumns) +
                         "WHERE e.state = 0 AND e.project = ? AND e.simulation_number = ?");
  query.bind(1, project);
  query.bind(2, simulation_number);
  if (!query.executeStep()) return std::nullopt;
  return stored_event(query);
}

EventPage query_events(Connection& db, const EventQuery& query) {
  EventPage page;
  if (!query.simulations.empty()) {
    Prepared events(db, std::string(kEventColumns) +
                            "WHERE e.simulation IN (SELECT value FROM json_each(?)) "
                            "AND e.number > ? ORDER BY e.number LIMIT ?");
    events.bind(1, json_array(query.simulations));
    events.bind(2, query.after);
    events.bind(3, kEventPage);
    page.through = query.after;
    read_events(events, page);
    if (!page.events.empty()) page.through = page.events.back().number;
    return page;
  }
  const std::int64_t latest = query_event_range(db).latest;
  page.through = std::min(latest, query.after + kEventWindow);
  const Condition condition = condition_of(db, query.project, query.restrictions);
  SQLite::Statement events(db, std::string(kEventColumns) +
                                   "WHERE e.number > ? AND e.number <= ? AND "
                                   "(e.state = 0 AND e.project = ? OR EXISTS "
                                   "(SELECT 1 FROM simulations WHERE id = e.simulation AND " +
                                   condition.sql + ")) ORDER BY e.number LIMIT ?");
  int index = 0;
  events.bind(++index, query.after);
  events.bind(++index, page.through);
  events.bind(++index, query.project);
  for (const PropertyValue& value : condition.values) bind_value(events, ++index, value);
  events.bind(++index, kEventPage);
  const std::int64_t window_end = page.through;
  read_events(events, page);
  page.more = page.more || window_end < latest;
  return page;
}

EventRange query_event_range(Connection& db) {
  Prepared query(db,
                 "SELECT (SELECT coalesce(max(number), 0) FROM events), forgotten FROM event_log");
  query.executeStep();
  return {query.getColumn(0).getInt64(), query.getColumn(1).getInt64()};
}

}  // namespace tribodyn::server
