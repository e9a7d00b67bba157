#include "server/storage/store.h"

#include <SQLiteCpp/Transaction.h>
#include <spdlog/spdlog.h>
#include <sqlite3.h>

#include <algorithm>
#include <exception>
#include <limits>

#include "server/storage/checksum.h"
#include "server/storage/database_check.h"
#include "server/storage/database_files.h"
#include "server/storage/durable_files.h"
#include "server/storage/event_rows.h"
#include "server/storage/maintenance.h"
#include "server/storage/resource_queries.h"
#include "server/storage/resource_rows.h"
#include "server/storage/schema.h"
#include "server/storage/simulation_queries.h"
#include "server/storage/simulation_rows.h"
#include "server/storage/translate_error.h"

namespace tribodyn::server {
namespace {

constexpr int kReaderConnections = 8;

std::filesystem::path usable_path(const std::filesystem::path& database) {
  std::filesystem::path path = canonical_path(database);
  require_usable_path(path);
  return path;
}

StoreError limits_over(const CallLimits& limits) {
  return limits.is_cancelled()
             ? StoreError(StoreError::Kind::kCancelled, "the caller gave up")
             : StoreError(StoreError::Kind::kDeadline, "the caller's deadline has passed");
}

void check(const CallLimits& limits) {
  if (limits.are_over()) throw limits_over(limits);
}

StoreError translate(const SQLite::Exception& error, const std::filesystem::path& path,
                     const CallLimits& limits) {
  return error.getErrorCode() == SQLITE_INTERRUPT ? limits_over(limits)
                                                  : translate_error(error, path);
}

Connection open_writer(const std::filesystem::path& path) try {
  configure_sqlite();
  return {path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyTimeoutMilliseconds};
} catch (const SQLite::Exception& error) {
  throw translate_error(error, path);
}

/// Thrown inside an action to roll back its change.
struct RollBack {};

/// Notes a change at its end, also after a failure: what failed may be on disk nevertheless.
class NotedChange {
 public:
  explicit NotedChange(RecentEvents& events) : events_(events) {}
  ~NotedChange() { events_.note_change(); }
  NotedChange(const NotedChange&) = delete;
  NotedChange& operator=(const NotedChange&) = delete;

 private:
  RecentEvents& events_;
};

}  // namespace

void Store::require_place() const {
  const std::string misplaced = this->misplaced();
  if (!misplaced.empty()) throw StoreError(StoreError::Kind::kMisplaced, misplaced);
}

/// Checks the files before the action, so that nothing is written in vain, and after it, so that no
/// change is acknowledged whose file has lost its name meanwhile.
template <class Action>
auto Store::write(const CallLimits& limits, const Action& action) {
  auto out = [&] {
    const std::lock_guard lock(writer_mutex_);
    check(limits);
    require_place();
    const NotedChange noted(recent_events_);
    try {
      const Connection::Under under(writer_, limits);
      auto result = action(writer_);
      require_place();
      return result;
    } catch (const SQLite::Exception& error) {
      throw translate(error, path_, limits);
    }
  }();
  observers_.tell();  // without the lock
  return out;
}

void Store::write_together(const CallLimits& limits, const GroupCommit::Action& action) {
  check(limits);
  require_place();
  try {
    const auto commit = [&] {
      const NotedChange noted(recent_events_);
      group_commit_.run(action, limits);
    };
    commit();
    require_place();
    observers_.tell();
  } catch (const RollBack&) {
    return;
  } catch (const SQLite::Exception& error) {
    throw translate(error, path_, limits);
  }
}

template <class Action>
auto Store::read(const CallLimits& limits, const Action& action) {
  check(limits);
  try {
    ReaderPool::Loan loan = readers_.borrow(limits);
    if (!loan) throw limits_over(limits);
    const Connection::Under under(*loan, limits);
    return action(*loan);
  } catch (const SQLite::Exception& error) {
    throw translate(error, path_, limits);
  }
}

Store::Store(const std::filesystem::path& database)
    : path_(usable_path(database)),
      lock_(path_),
      writer_(open_writer(path_)),
      group_commit_(writer_, writer_mutex_) {
  open_schema();
  writer_.heed_limits();
  try {
    // The writer keeps its statement journal (old pages, a few hundred KiB) in memory, so that it
    // opens no file later.
    writer_.exec("PRAGMA temp_store = MEMORY");
    readers_.open(path_, kReaderConnections);
    lock_.lock_new_file();
    files_.emplace(path_);
    lock_.remember(files_->record());
  } catch (const SQLite::Exception& error) {
    throw translate_error(error, path_);
  }
}

Store::~Store() {
  // With the connections still open: SQLite leaves the log alone when it closes a database that is
  // not in its place.
  try {
    const std::filesystem::path log = files_ ? files_->set_log_aside() : std::filesystem::path();
    if (log.empty()) return;
    spdlog::critical(
        "another file took the place of database {}; the write-ahead log of the former database, "
        "with its latest changes, is kept as {}: if the former database has another name by now, "
        "rename the log to that name followed by -wal before anything opens that file; else the "
        "log is of no use",
        path_.string(), log.string());
  } catch (const std::exception& error) {
    spdlog::critical("{}", error.what());
  }
}

void Store::open_schema() {
  write({}, [this](Connection& db) {
    require_servable(db, path_);
    const int version = db.execAndGet("PRAGMA user_version").getInt();
    if (sqlite3_db_readonly(db.getHandle(), "main") == 1) {
      throw StoreError(StoreError::Kind::kReadOnly,
                       "database " + path_.string() + " cannot be written: it is read-only");
    }
    // SQLite reports some errors only by another mode.
    if (db.execAndGet("PRAGMA journal_mode = WAL").getString() != "wal") {
      throw StoreError(StoreError::Kind::kFailed,
                       "database " + path_.string() + ": cannot create its write-ahead log");
    }
    db.exec("PRAGMA synchronous = FULL");
    db.exec("PRAGMA foreign_keys = ON");
    if (0 < version && version < kSchemaVersion) {
      migration_backup_ = backup_before_migration(path_, version);
    }
    if (version < kSchemaVersion) migrate(db, version, system_time());
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    const int renewed = add_missing_properties(db);
    transaction.commit();
    if (renewed > 0) spdlog::info("lists can filter {} resources by newer fields", renewed);
    SQLite::Statement projects(db, "SELECT name FROM projects");
    const std::lock_guard lock(projects_mutex_);
    while (projects.executeStep()) projects_.insert(projects.getColumn(0).getString());
    return true;
  });
}

void Store::add_resources(const std::vector<NewResource>& resources, Microseconds now) {
  write({}, [&](Connection& db) {
    SQLite::Transaction transaction(db);
    for (const NewResource& each : resources) {
      if (!is_taken(db, each.name)) insert_resource(db, each, now);
    }
    transaction.commit();
    return true;
  });
}

void Store::add_project(const std::string& project, const std::vector<NewResource>& resources,
                        Microseconds now) {
  write({}, [&](Connection& db) {
    SQLite::Transaction transaction(db);
    Prepared insert(db, "INSERT INTO projects (name) VALUES (?) ON CONFLICT DO NOTHING");
    insert.bind(1, project);
    insert.exec();
    for (const NewResource& each : resources) {
      const std::string name = full_name(project, each.name);
      if (!is_taken(db, name)) insert_resource(db, {name, each.body}, now);
    }
    transaction.commit();
    return true;
  });
  const std::lock_guard lock(projects_mutex_);
  projects_.insert(project);
}

bool Store::has_project(const std::string& project) const {
  const std::lock_guard lock(projects_mutex_);
  return projects_.contains(project);
}

std::optional<StoredResource> Store::resource(const std::string& name, const CallLimits& limits) {
  return read(limits, [&](Connection& db) -> std::optional<StoredResource> {
    Prepared query(db,
                   std::string(kResourceColumns) +
                       "FROM resources r JOIN revisions v ON v.id = r.present WHERE r.name = ?");
    query.bind(1, name);
    if (!query.executeStep()) return std::nullopt;
    return stored_resource(query);
  });
}

std::optional<StoredResource> Store::revision(const std::string& name, int revision,
                                              const CallLimits& limits) {
  return read(limits, [&](Connection& db) -> std::optional<StoredResource> {
    Prepared query(db, std::string(kResourceColumns) +
                           "FROM resources r JOIN revisions v ON v.resource = r.id "
                           "WHERE r.name = ? AND v.revision = ?");
    query.bind(1, name);
    query.bind(2, revision);
    if (!query.executeStep()) return std::nullopt;
    return stored_resource(query);
  });
}

Page<StoredResource> Store::resources(const ResourceQuery& query, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_resources(db, query); });
}

Page<StoredResource> Store::revisions(const std::string& name, int before, int limit,
                                      std::size_t byte_limit, const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared query(db, std::string(kResourceColumns) +
                           "FROM resources r JOIN revisions v ON v.resource = r.id "
                           "WHERE r.name = ? AND v.revision < ? "
                           "ORDER BY v.revision DESC LIMIT ?");
    query.bind(1, name);
    query.bind(2, before == 0 ? std::numeric_limits<int>::max() : before);
    query.bind(3, limit + 1);
    return read_page<StoredResource>(query, limit, byte_limit, kBodyColumn, stored_resource);
  });
}

std::vector<std::string> Store::resource_names(const std::string& project,
                                               const std::string& collection,
                                               const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared query(
        db,
        "SELECT name FROM resources WHERE collection = ? AND delete_time IS NULL ORDER BY name");
    query.bind(1, full_name(project, collection));
    std::vector<std::string> names;
    while (query.executeStep()) names.push_back(relative_name(query.getColumn(0).getString()));
    return names;
  });
}

std::optional<std::vector<StoredResource>> Store::write_resources(
    const std::vector<ResourceWrite>& writes, Microseconds now, const CallLimits& limits) {
  return write(limits, [&](Connection& db) -> std::optional<std::vector<StoredResource>> {
    SQLite::Transaction transaction(db);
    std::vector<StoredResource> written;
    written.reserve(writes.size());
    for (const auto& [resource, present] : writes) {
      if (present ? !is_unchanged(db, *present) : is_taken(db, resource.name)) return std::nullopt;
      written.push_back(present ? insert_revision(db, *present, resource.body, now)
                                : insert_resource(db, resource, now));
    }
    transaction.commit();
    return written;
  });
}

template <class Change>
bool Store::change(const CallLimits& limits, const StoredResource& present, const Change& change) {
  return write(limits, [&](Connection& db) {
    SQLite::Transaction transaction(db);
    if (!is_unchanged(db, present)) return false;
    change(db);
    transaction.commit();
    return true;
  });
}

bool Store::delete_resource(const StoredResource& present, Microseconds now,
                            const CallLimits& limits) {
  return change(limits, present, [&](Connection& db) {
    Prepared mark(db, "UPDATE resources SET delete_time = ? WHERE id = ?");
    mark.bind(1, now);
    mark.bind(2, present.id);
    mark.exec();
  });
}

bool Store::undelete_resource(const StoredResource& present, const CallLimits& limits) {
  return change(limits, present, [&](Connection& db) {
    Prepared mark(db, "UPDATE resources SET delete_time = NULL WHERE id = ?");
    mark.bind(1, present.id);
    mark.exec();
  });
}

AddOutcome Store::add_simulation(const NewSimulation& simulation, Microseconds now, bool may_wait,
                                 const CallLimits& limits) {
  AddOutcome added;
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
  return read(limits, [&](Connection& db) -> std::optional<StoredSimulation> {
    Prepared query(db, std::string(kSimulationColumns) + "WHERE project = ? AND number = ?");
    query.bind(1, project);
    query.bind(2, number);
    if (!query.executeStep()) return std::nullopt;
    return stored_simulation(query);
  });
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
    Prepared update(db, "UPDATE simulations SET pinned = ? WHERE id = ?");
    update.bind(1, is_pinned ? 1 : 0);
    update.bind(2, id);
    update.exec();
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
    Prepared query(db, "SELECT state, pinned, request FROM simulations WHERE id = ?");
    query.bind(1, id);
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

Store::Purge Store::purge_resource(const StoredResource& present, bool with_dependents,
                                   const CallLimits& limits) {
  return write(limits, [&](Connection& db) {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    Purge out{.is_current = is_unchanged(db, present),
              .dependents = server::dependents_of(db, present)};
    const bool may_go = out.dependents.are_ended() && (with_dependents || !out.dependents.exist());
    if (!out.is_current || !may_go) return out;
    has_unerased_purge_ = true;
    out.revisions = remove_resource(db, present);
    transaction.commit();
    return out;
  });
}

Dependents Store::dependents_of(const StoredResource& present, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return server::dependents_of(db, present); });
}

std::vector<std::filesystem::path> Store::erase_removed() {
  write({}, [this](Connection& db) {
    server::erase_removed(db);
    remove_migration_backups(path_);
    has_unerased_purge_ = false;  // under the writer's lock: no purge comes between
    return true;
  });
  return former_databases(path_);
}

Removed Store::remove_oldest(Microseconds ended_by, int limit) {
  return write({}, [&](Connection& db) {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    const Removed removed = server::remove_oldest(db, ended_by, limit);
    transaction.commit();
    return removed;
  });
}

std::int64_t Store::used_bytes() {
  return read({}, [](Connection& db) { return server::used_bytes(db); });
}

std::int64_t Store::removable_bytes() {
  return read({}, [](Connection& db) { return server::removable_bytes(db); });
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

std::int64_t Store::result_bytes(const std::string& project, const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared sum(db,
                 "SELECT (SELECT coalesce(sum(stored_bytes), 0) FROM results WHERE project = ?1) + "
                 "(SELECT coalesce(sum(stored_bytes), 0) FROM campaigns WHERE project = ?1)");
    sum.bind(1, project);
    sum.executeStep();
    return sum.getColumn(0).getInt64();
  });
}

double Store::unfinished_seconds(const std::string& project, const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared sum(db,
                 "SELECT (SELECT coalesce(sum(cost_seconds), 0) FROM simulations "
                 "WHERE project = ?1 AND state IN (1, 2)) + "
                 "(SELECT coalesce(sum(cost_seconds * (1 - 1.0 * points_done / "
                 "(candidates * conditions))), 0) FROM campaigns INDEXED BY running_campaigns "
                 "WHERE project = ?1 AND state = 1)");
    sum.bind(1, project);
    sum.executeStep();
    return sum.getColumn(0).getDouble();
  });
}

EventRange Store::event_range(const std::string& project, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_event_range(db, project); });
}

template <class Change>
std::optional<StoredEvent> Store::change_simulation(const CallLimits& limits,
                                                    const Change& change) {
  std::optional<StoredEvent> event;
  write_together(limits, [&](Connection& db) {
    event = change(db);
    if (!event) throw RollBack();
  });
  return event;
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

CampaignAdded Store::add_campaign(const NewCampaign& campaign, Microseconds now,
                                  const CallLimits& limits) {
  CampaignAdded out;
  write_together(limits, [&](Connection& db) { out = insert_campaign(db, campaign, now); });
  return out;
}

std::optional<StoredCampaign> Store::campaign(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_campaign(db, id); });
}

std::optional<StoredCampaign> Store::numbered_campaign(const std::string& project,
                                                       std::int64_t number,
                                                       const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_numbered_campaign(db, project, number); });
}

std::optional<StoredCampaign> Store::campaign_of_request(const std::string& project,
                                                         const std::string& request_id,
                                                         const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_campaign_of_request(db, project, request_id); });
}

Page<StoredCampaign> Store::campaigns(const CampaignQuery& query, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_campaigns(db, query); });
}

std::optional<StoredCampaign> Store::relabel_campaign(const StoredCampaign& present,
                                                      const std::string& request,
                                                      const CampaignLabels& labels,
                                                      const CallLimits& limits) {
  std::optional<StoredCampaign> out;
  write_together(limits, [&](Connection& db) {
    out.reset();
    if (server::relabel_campaign(db, present.id, present.request, request, labels)) {
      out = query_campaign(db, present.id);
    }
  });
  return out;
}

CandidatesAdded Store::add_candidates(const NewCandidates& added, Microseconds now,
                                      int lost_attempts, const CallLimits& limits) {
  CandidatesAdded out;
  write_together(limits,
                 [&](Connection& db) { out = insert_candidates(db, added, now, lost_attempts); });
  tell_campaign_change();
  return out;
}

std::optional<CandidatesAdded::Kind> Store::append_of_request(std::int64_t id,
                                                              const std::string& request_id,
                                                              const std::string& request_hash,
                                                              const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_append(db, id, request_id, request_hash); });
}

int Store::created_candidates(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_created_candidates(db, id); });
}

std::vector<std::int64_t> Store::resume_campaigns() {
  std::vector<std::int64_t> out;
  write_together({}, [&](Connection& db) { out = server::resume_campaigns(db); });
  return out;
}

std::string Store::candidate_table(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_candidate_table(db, id); });
}

std::optional<StoredCampaign> Store::change_campaign(const CampaignChange& change,
                                                     const CallLimits& limits) {
  std::optional<StoredCampaign> out;
  write_together(limits, [&](Connection& db) { out = server::change_campaign(db, change); });
  tell_campaign_change();
  return out;
}

std::optional<StoredCampaign> Store::begin_campaign(std::int64_t id) {
  std::optional<StoredCampaign> out;
  write_together({}, [&](Connection& db) { out = server::begin_campaign(db, id); });
  tell_campaign_change();  // it may pause the campaign
  return out;
}

void Store::release_campaign(std::int64_t id) {
  write_together({}, [&](Connection& db) { server::release_campaign(db, id); });
}

std::vector<CampaignSuspect> Store::campaign_suspects(std::int64_t id) {
  return read({}, [&](Connection& db) { return query_suspects(db, id); });
}

void Store::begin_suspect(std::int64_t id, const RowRange& rows) {
  write_together({}, [&](Connection& db) { server::begin_suspect(db, id, rows); });
}

void Store::end_suspects(std::int64_t id) {
  write_together({}, [&](Connection& db) { server::end_suspects(db, id); });
}

std::optional<StoredCampaign> Store::add_tile(std::int64_t id, const NewTile& tile,
                                              Microseconds now,
                                              const std::function<void()>& between_columns) {
  // Compresses before the transaction, so that other writers do not wait.
  const std::vector<std::string> blobs = compress_tile(tile, between_columns);
  std::optional<StoredCampaign> out;
  write_together({}, [&](Connection& db) { out = insert_tile(db, id, tile, blobs, now); });
  tell_campaign_change();
  return out;
}

void Store::tell_campaign_change() {
  ++campaign_changes_;  // before anybody is notified, so that who looks then finds it
  campaign_observers_.tell();
}

std::optional<CampaignProgress> Store::campaign_progress(std::int64_t id,
                                                         std::int64_t first_missing_row,
                                                         const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_campaign_progress(db, id, first_missing_row); });
}

std::vector<RowRange> Store::campaign_tiles(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_tiles(db, id); });
}

std::vector<CampaignRefusal> Store::campaign_refusals(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_refusals(db, id); });
}

bool Store::remove_campaign(std::int64_t id, const CallLimits& limits) {
  const bool is_gone = write(limits, [&](Connection& db) {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    const auto stored = query_campaign(db, id);
    if (stored && !has_ended(stored->state)) return false;
    server::remove_campaign(db, id);
    transaction.commit();
    return true;
  });
  if (is_gone) tell_campaign_change();
  return is_gone;
}

void Store::read_campaign(std::int64_t id, int column, std::int64_t start, std::span<double> values,
                          const CallLimits& limits) {
  read(limits, [&](Connection& db) {
    query_campaign_column(db, id, column, start, values);
    return true;
  });
}

std::optional<std::string> Store::result(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_result(db, id); });
}

HistoryShape Store::history_shape(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared query(db, "SELECT result FROM simulations WHERE id = ?");
    query.bind(1, id);
    const bool has_result = query.executeStep() && !query.getColumn(0).isNull();
    return has_result ? query_history_shape(db, query.getColumn(0).getInt64()) : HistoryShape();
  });
}

bool Store::read_history(std::int64_t column, int level, std::int64_t start,
                         std::span<double> values, const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_history(db, column, level, start, values); });
}

std::vector<double> Store::history_rows(std::int64_t id, const std::string& column,
                                        std::int64_t start, std::int64_t count) {
  const HistoryShape shape = history_shape(id);
  const auto found = std::find(shape.names.begin(), shape.names.end(), column);
  std::vector<double> values(static_cast<std::size_t>(count));
  if (found == shape.names.end() ||
      !read_history(shape.columns[found - shape.names.begin()], 0, start, values)) {
    throw StoreError(StoreError::Kind::kFailed, "the history has no such column");
  }
  return values;
}

}  // namespace tribodyn::server
