#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "server/storage/call_limits.h"
#include "server/storage/campaign_rows.h"
#include "server/storage/checkpointer.h"
#include "server/storage/connections.h"
#include "server/storage/database_files.h"
#include "server/storage/database_lock.h"
#include "server/storage/group_commit.h"
#include "server/storage/history_rows.h"
#include "server/storage/recent_events.h"
#include "server/storage/removal.h"
#include "server/storage/retention.h"
#include "server/storage/schema.h"
#include "server/storage/store_error.h"
#include "server/storage/stored_campaign.h"
#include "server/storage/stored_resource.h"
#include "server/storage/stored_simulation.h"
#include "server/support/observers.h"

namespace tribodyn::server {

/// Stores resources, simulations and results in one database (schema.h), which is the only source
/// of truth. Safe for concurrent access without external synchronization: one writer at a time,
/// several readers beside it. A call that changes something returns when the change is on disk in
/// the file at the path. A call on behalf of a client takes the limits of its call. Throws
/// StoreError.
class Store {
 public:
  /// Opens or creates the database and locks it against other servers.
  explicit Store(const std::filesystem::path& database, const SchemaSteps& steps = schema_steps(),
                 std::chrono::milliseconds lock_wait = {});
  /// If another file took the place of the database, sets the write-ahead log aside, which would
  /// destroy that file (DatabaseFiles::set_log_aside), and tells the log of the process.
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Like DatabaseFiles::misplaced(). While the result is not empty, calls that change something
  /// throw StoreError kMisplaced.
  std::string misplaced() const { return files_ ? files_->misplaced() : std::string(); }

  /// Returns the path of the copy that the constructor made before a migration; nullopt if it did
  /// not migrate the database.
  const std::optional<std::filesystem::path>& migration_backup() const { return migration_backup_; }

  /// Adds a project, unless it exists, and those of the resources that it does not have, deleted or
  /// not, in one transaction. `resources` have relative names.
  void add_project(const std::string& project, const std::vector<NewResource>& resources,
                   Microseconds now);
  /// Reads no row: the store remembers the names of all projects.
  bool has_project(const std::string& project) const;

  // A resource is stored and found under its full name (resource_names.h): a call about one project
  // reads no row of another.

  /// Returns the current revision of a resource, also of a deleted one.
  std::optional<StoredResource> resource(const std::string& name, const CallLimits& limits = {});
  std::optional<StoredResource> revision(const std::string& name, int revision,
                                         const CallLimits& limits = {});
  Page<StoredResource> resources(const ResourceQuery& query, const CallLimits& limits = {});
  /// Returns revisions, latest first, that are older than `before` (0: all). A page has at most
  /// `limit` rows and `byte_limit` bytes, but at least one row.
  Page<StoredResource> revisions(const std::string& name, int before, int limit,
                                 std::size_t byte_limit, const CallLimits& limits = {});
  /// Returns the relative names of all resources of a collection of a project that are not deleted,
  /// sorted.
  std::vector<std::string> resource_names(const std::string& project, const std::string& collection,
                                          const CallLimits& limits = {});

  /// Writes all resources in one transaction and returns them as stored. Returns nullopt, and
  /// changes nothing, if the name of a new resource exists (even deleted), or if another resource
  /// has changed since it was read.
  std::optional<std::vector<StoredResource>> write_resources(
      const std::vector<ResourceWrite>& writes, Microseconds now, const CallLimits& limits = {});
  // These functions change the resource `present`. They return false, and change nothing, if the
  // resource has changed since it was read.
  bool delete_resource(const StoredResource& present, Microseconds now,
                       const CallLimits& limits = {});
  bool undelete_resource(const StoredResource& present, const CallLimits& limits = {});

  /// Adds a simulation, or returns the one that an earlier request with the same request_id added
  /// to the same project.
  /// If not `may_wait`, adds it only if its result exists.
  AddOutcome add_simulation(const NewSimulation& simulation, Microseconds now, bool may_wait = true,
                            const CallLimits& limits = {});
  /// Returns the simulation of a row, over all projects. Clients know numbers, not rows.
  std::optional<StoredSimulation> simulation(std::int64_t id, const CallLimits& limits = {});
  std::optional<StoredSimulation> numbered_simulation(const std::string& project,
                                                      std::int64_t number,
                                                      const CallLimits& limits = {});
  /// Returns the simulation that a request with this request_id added to the project.
  std::optional<StoredSimulation> simulation_of_request(const std::string& project,
                                                        const std::string& request_id,
                                                        const CallLimits& limits = {});
  Page<StoredSimulation> simulations(const SimulationQuery& query, const CallLimits& limits = {});
  /// Protects a simulation from removal, or ends the protection. Returns the changed simulation;
  /// nullopt if it does not exist.
  std::optional<StoredSimulation> set_pinned(std::int64_t id, bool is_pinned,
                                             const CallLimits& limits = {});
  /// Replaces the request of a simulation by one with another display name or labels, and its
  /// labels. Returns the simulation as it is then; nullopt, and changes nothing, if its request is
  /// no longer that of `present`.
  std::optional<StoredSimulation> relabel_simulation(
      const StoredSimulation& present, const std::string& request,
      const std::vector<std::pair<std::string, std::string>>& labels,
      const CallLimits& limits = {});
  /// Removes a simulation. Changes nothing unless it has ended, is not pinned and, if `request` is
  /// stated, still has that request.
  enum class Removal { kDone, kAbsent, kUnfinished, kPinned, kChanged };
  Removal remove_simulation(std::int64_t id, const std::optional<std::string>& request = {},
                            const CallLimits& limits = {});
  /// Removes a resource with all its revisions and, if `with_dependents`, every simulation and
  /// campaign that used one of them. Changes nothing, and returns revisions 0, if the resource has
  /// changed since it was read, if such a simulation or campaign is unfinished, or if there is one
  /// and `with_dependents` is false. Free pages of the files still contain the removed bytes until
  /// erase_removed().
  struct Purge {
    bool is_current = false;  ///< the resource has not changed since it was read
    Dependents dependents;    ///< what used the resource
    int revisions = 0;        ///< removed revisions
  };
  Purge purge_resource(const StoredResource& present, bool with_dependents,
                       const CallLimits& limits = {});
  /// Returns what purge_resource() would find, and changes nothing.
  Dependents dependents_of(const StoredResource& present, const CallLimits& limits = {});
  /// Like erase_removed() of removal.h. `also_from_copies`: removes the copies that migrations
  /// made. Other writers wait meanwhile. Returns the copies beside the database that may still
  /// contain removed rows: also the databases that restores kept.
  std::vector<std::filesystem::path> erase_removed(bool also_from_copies = true);
  /// Returns false if nothing was purged since the last erase_removed(). True in a new process, as
  /// the one before may have ended between the two.
  bool has_unerased_purge() const { return has_unerased_purge_; }

  // Like the functions of retention.h.
  Removed remove_oldest(Microseconds ended_by, int limit);
  std::int64_t used_bytes();
  std::int64_t removable_bytes();
  /// Returns the time at which the latest simulation was created; nullopt if there is none.
  std::optional<Microseconds> latest_creation();
  /// Returns the event after number `after_sequence` (0: the first event); nullopt if there is
  /// none.
  std::optional<StoredEvent> next_event(std::int64_t id, std::int64_t after_sequence,
                                        const CallLimits& limits = {});
  /// Like query_deletion(), query_events() and query_event_range() of event_rows.h.
  std::optional<StoredEvent> deletion(const std::string& project, std::int64_t simulation_number,
                                      const CallLimits& limits = {});
  EventPage events(const EventQuery& query, const CallLimits& limits = {});
  /// Like the functions of RecentEvents.
  std::optional<EventPage> recent_events(const std::string& project, std::int64_t after,
                                         const CallLimits& limits = {});
  RecentEvents::States simulation_states(const std::string& project,
                                         const std::vector<std::int64_t>& numbers,
                                         const CallLimits& limits = {});
  std::uint64_t changes() const { return recent_events_.changes(); }
  /// Returns the bytes of all results of a project, with their histories, and of its campaigns.
  std::int64_t result_bytes(const std::string& project, const CallLimits& limits = {});
  /// Returns the estimated cost of all simulations of a project that wait or run, and of what is
  /// left of its campaigns that run [s of one processor].
  double unfinished_seconds(const std::string& project, const CallLimits& limits = {});
  EventRange event_range(const std::string& project, const CallLimits& limits = {});
  /// Tells the observer of every later commit, for as long as it lives.
  void observe(const std::weak_ptr<Observer>& observer) { observers_.add(observer); }

  // These functions change the state of a simulation and add the event in one transaction. They
  // return the event. They return nullopt, and change nothing, if the simulation is not in a state
  // that allows the change: of two concurrent changes the first wins.

  // `attempt`: number of the only attempt that may change; empty: any.

  /// Changes QUEUED to RUNNING under a lease, or to SUCCEEDED if equal inputs have a result by now.
  std::optional<StoredEvent> mark_running(std::int64_t id, Microseconds now, const ResultKey& key,
                                          const LeaseTerms& lease = {});
  /// Extends the lease of an attempt to `expire_time`. Returns false if the attempt has ended.
  bool extend_lease(std::int64_t id, int attempt, Microseconds expire_time);
  /// Changes RUNNING to QUEUED for a further attempt because the worker of this one was lost, or to
  /// FAILED after kMaximumLostAttempts lost attempts.
  std::optional<StoredEvent> mark_lost(std::int64_t id, int attempt, Microseconds now,
                                       const std::string& reason);
  /// Changes RUNNING to QUEUED for a further attempt.
  std::optional<StoredEvent> mark_queued(std::int64_t id, Microseconds now,
                                         const std::string& reason,
                                         std::optional<int> attempt = {});
  std::optional<StoredEvent> mark_cancelled(std::int64_t id, Microseconds now,
                                            const CallLimits& limits = {});
  std::optional<StoredEvent> mark_failed(std::int64_t id, Microseconds now,
                                         const std::string& reason, const std::string& message,
                                         std::optional<int> attempt = {});
  /// Changes RUNNING to SUCCEEDED and stores the result. If equal inputs have another result by
  /// now, the simulation becomes FAILED, unless that result is damaged: then the new one replaces
  /// it.
  std::optional<StoredEvent> mark_succeeded(std::int64_t id, Microseconds now,
                                            const NewResult& result,
                                            std::optional<int> attempt = {});

  /// Treats, after a crash, the attempts of this process and those whose lease has expired as
  /// mark_lost() does. Returns all simulations that have not ended then, oldest first; those that
  /// another process computes come with their lease.
  std::vector<UnfinishedSimulation> requeue_unfinished(Microseconds now);

  // Campaigns, as in campaign_rows.h.

  CampaignAdded add_campaign(const NewCampaign& campaign, Microseconds now,
                             const CallLimits& limits = {});
  std::optional<StoredCampaign> campaign(std::int64_t id, const CallLimits& limits = {});
  std::optional<StoredCampaign> numbered_campaign(const std::string& project, std::int64_t number,
                                                  const CallLimits& limits = {});
  std::optional<StoredCampaign> campaign_of_request(const std::string& project,
                                                    const std::string& request_id,
                                                    const CallLimits& limits = {});
  Page<StoredCampaign> campaigns(const CampaignQuery& query, const CallLimits& limits = {});
  /// Replaces the request of a campaign, its labels and, if stated, its table of candidates.
  /// Returns nullopt, and changes nothing, if its request or its number of candidates is no longer
  /// that of `present`.
  std::optional<StoredCampaign> describe_campaign(const StoredCampaign& present,
                                                  const std::string& request,
                                                  const CampaignLabels& labels,
                                                  const std::optional<std::string>& candidate_table,
                                                  const CallLimits& limits = {});
  CandidatesAdded add_candidates(const NewCandidates& added, Microseconds now, int lost_attempts,
                                 const CallLimits& limits = {});
  std::optional<CandidatesAdded::Kind> append_of_request(std::int64_t id,
                                                         const std::string& request_id,
                                                         const std::string& request_hash,
                                                         const CallLimits& limits = {});
  int created_candidates(std::int64_t id, const CallLimits& limits = {});
  std::vector<std::int64_t> resume_campaigns();
  std::vector<std::int64_t> paused_campaigns();
  std::string candidate_table(std::int64_t id, const CallLimits& limits = {});
  std::optional<StoredCampaign> change_campaign(const CampaignChange& change,
                                                const CallLimits& limits = {});
  std::optional<StoredCampaign> begin_campaign(std::int64_t id);
  void release_campaign(std::int64_t id);
  std::vector<CampaignSuspect> campaign_suspects(std::int64_t id);
  void begin_suspect(std::int64_t id, const RowRange& rows);
  void end_suspects(std::int64_t id);
  /// Calls `between_columns`, if there is one, before it compresses each column, while nothing is
  /// locked.
  std::optional<StoredCampaign> add_tile(std::int64_t id, const NewTile& tile, Microseconds now,
                                         const std::function<void()>& between_columns = {});
  std::optional<CampaignProgress> campaign_progress(std::int64_t id, std::int64_t first_missing_row,
                                                    const CallLimits& limits = {});
  /// Returns a number that grows with each change of a campaign that this process made by one of
  /// these functions, and with each call of tell_campaign_change().
  std::uint64_t campaign_changes() const { return campaign_changes_; }
  /// Tells observers that something has changed of a campaign that the store does not hold.
  void tell_campaign_change();
  /// Notifies the observer of every later change of a campaign until it is destroyed.
  void observe_campaigns(const std::weak_ptr<Observer>& observer) {
    campaign_observers_.add(observer);
  }
  std::vector<RowRange> campaign_tiles(std::int64_t id, const CallLimits& limits = {});
  std::vector<CampaignRefusal> campaign_refusals(std::int64_t id, const CallLimits& limits = {});
  /// Removes a campaign that has ended. Returns false, and changes nothing, if it has not; true if
  /// it does not exist.
  bool remove_campaign(std::int64_t id, const CallLimits& limits = {});

  // These functions compare stored bytes with their checksums and throw StoreError kDataLoss if
  // they differ.

  void read_campaign(std::int64_t id, int column, std::int64_t start, std::span<double> values,
                     const CallLimits& limits = {});

  /// Returns the serialised SimulationResult with the assumptions of this simulation.
  std::optional<std::string> result(std::int64_t id, const CallLimits& limits = {});
  /// Returns a simulation by its number in the project, with its result and the columns of its
  /// history if it has succeeded.
  std::optional<StoredHistory> stored_history(const std::string& project, std::int64_t number,
                                              const CallLimits& limits = {});
  HistoryShape history_shape(std::int64_t id, const CallLimits& limits = {});
  /// Reads doubles [start, start + values.size()) of a level (pyramid.h) of a column. Returns false
  /// if the column no longer exists.
  bool read_history(std::int64_t column, int level, std::int64_t start, std::span<double> values,
                    const CallLimits& limits = {});

 private:
  void open_schema(const SchemaSteps& steps);
  void require_place() const;
  /// The arguments must outlive the result.
  RecentEvents::Source event_source(const std::string& project, const CallLimits& limits);
  /// Changes a row of resources if the stored resource is still `present`.
  template <class Change>
  bool change(const CallLimits& limits, const StoredResource& present, const Change& change);
  /// Runs a change in one transaction, and rolls it back if it returns no event.
  std::optional<StoredEvent> change_simulation(
      const CallLimits& limits,
      const std::function<std::optional<StoredEvent>(Connection&)>& change);
  /// Runs an action on the writer's connection, with no other write beside it, and returns what the
  /// action returns.
  template <class Action>
  auto write(const CallLimits& limits, const Action& action);
  void run_write(const CallLimits& limits, const GroupCommit::Action& action);
  /// Runs an action in a transaction that it may share with others.
  void write_together(const CallLimits& limits, const GroupCommit::Action& action);
  /// Runs an action on a connection of a reader, and returns what the action returns.
  template <class Action>
  auto read(const CallLimits& limits, const Action& action);
  void run_read(const CallLimits& limits, const GroupCommit::Action& action);

  const std::filesystem::path path_;
  DatabaseLock lock_;
  std::mutex writer_mutex_;
  Connection writer_;  // guarded by writer_mutex_
  GroupCommit group_commit_;
  ReaderPool readers_;
  std::optional<std::filesystem::path> migration_backup_;
  std::atomic<bool> has_unerased_purge_ = true;
  RecentEvents recent_events_;
  Observers observers_;
  std::atomic<std::uint64_t> campaign_changes_ = 1;
  Observers campaign_observers_;
  std::optional<DatabaseFiles> files_;  // set by the constructor when the files exist
  mutable std::mutex projects_mutex_;
  std::set<std::string> projects_;            // guarded by projects_mutex_; those of the database
  std::optional<Checkpointer> checkpointer_;  // set by the constructor
};

}  // namespace tribodyn::server
