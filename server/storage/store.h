#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/storage/call_limits.h"
#include "server/storage/connections.h"
#include "server/storage/database_files.h"
#include "server/storage/database_lock.h"
#include "server/storage/group_commit.h"
#include "server/storage/history_rows.h"
#include "server/storage/removal.h"
#include "server/storage/retention.h"
#include "server/storage/store_error.h"
#include "server/storage/stored_resource.h"
#include "server/storage/stored_simulation.h"

namespace tribodyn::server {

/// Safe for concurrent access without external synchronization: one writer at a time, readers
/// beside it. The only truth about resources, simulations and results (schema.h). A call that
/// changes something returns when the change is on disk, in the file at the path. A call that is
/// made for a client takes how long the client waits. Throws StoreError.
class Store {
 public:
  /// Opens or creates the database and keeps other servers away from it.
  explicit Store(const std::filesystem::path& database);

  /// As DatabaseFiles::misplaced. While it tells something, calls that would change something throw
  /// StoreError kMisplaced.
  std::string misplaced() const { return files_ ? files_->misplaced() : std::string(); }

  /// Where the database was copied to before the constructor migrated it to the present schema;
  /// nullopt if the constructor did not.
  const std::optional<std::filesystem::path>& migration_backup() const { return migration_backup_; }

  /// Adds what is missing in one transaction; what exists, deleted or not, stays as it is.
  void add_resources(const std::vector<NewResource>& resources, Microseconds now);
  /// The present revision, of a deleted resource too.
  std::optional<StoredResource> resource(const std::string& name, const CallLimits& limits = {});
  std::optional<StoredResource> revision(const std::string& name, int revision,
                                         const CallLimits& limits = {});
  Page<StoredResource> resources(const ResourceQuery& query, const CallLimits& limits = {});
  /// Newest first, those before `before` (0: from the newest): `limit` rows, or fewer so that they
  /// stay within `byte_limit`, but at least one.
  Page<StoredResource> revisions(const std::string& name, int before, int limit,
                                 std::size_t byte_limit, const CallLimits& limits = {});
  /// All that are not deleted, sorted.
  std::vector<std::string> resource_names(const std::string& collection,
                                          const CallLimits& limits = {});

  /// All of them in one transaction; what they are then. Nothing, and nothing is changed, when the
  /// name of a new one is taken, if only by a deleted resource, or a present one has changed since
  /// it was read.
  std::optional<std::vector<StoredResource>> write_resources(
      const std::vector<ResourceWrite>& writes, Microseconds now, const CallLimits& limits = {});
  // Changes of `present`, as it was read. Each returns false, and changes nothing, when the
  // resource has changed since.
  bool delete_resource(const StoredResource& present, Microseconds now,
                       const CallLimits& limits = {});
  bool undelete_resource(const StoredResource& present, const CallLimits& limits = {});

  /// A new simulation, or the one that an earlier request of its request_id made. Without
  /// `may_wait` only where a result for it is there already.
  Added add_simulation(const NewSimulation& simulation, Microseconds now, bool may_wait = true,
                       const CallLimits& limits = {});
  std::optional<StoredSimulation> simulation(std::int64_t id, const CallLimits& limits = {});
  std::optional<std::int64_t> simulation_of_request(const std::string& request_id,
                                                    const CallLimits& limits = {});
  Page<StoredSimulation> simulations(const SimulationQuery& query, const CallLimits& limits = {});
  /// Keeps a simulation from being removed, or lets it be removed again. Returns the simulation as
  /// it is then; nullopt if there is none.
  std::optional<StoredSimulation> set_pinned(std::int64_t id, bool is_pinned,
                                             const CallLimits& limits = {});
  /// Removes a simulation that has ended and is not pinned.
  enum class Removal { kDone, kAbsent, kUnfinished, kPinned };
  Removal remove_simulation(std::int64_t id, const CallLimits& limits = {});
  /// Removes a resource with all its revisions and, if `with_simulations`, every simulation that
  /// was computed with one of them. Changes nothing, and returns revisions 0, if the resource has
  /// changed since it was read, if such a simulation is unfinished, or if there is one and they are
  /// not to go. Free pages of the files still hold what was removed, until erase_removed().
  struct Purge {
    bool is_current = false;  ///< the resource was as it had been read
    Dependents simulations;   ///< computed with it
    int revisions = 0;        ///< removed
  };
  Purge purge_resource(const StoredResource& present, bool with_simulations,
                       const CallLimits& limits = {});
  /// As in removal.h, and removes the copies that migrations made. Other writers wait meanwhile.
  /// Returns the former databases that restores kept, which may still hold what was removed.
  std::vector<std::filesystem::path> erase_removed();

  // As the functions of retention.h.
  Removed remove_oldest(Microseconds ended_by, int limit);
  std::int64_t used_bytes();
  std::int64_t removable_bytes();
  /// The change of state that follows the one of that number (0: the first).
  std::optional<StoredEvent> next_event(std::int64_t id, std::int64_t after_sequence,
                                        const CallLimits& limits = {});

  // Changes of state, each with its event in one transaction. They return the event, or nothing,
  // and then change nothing, when the simulation is not in a state that allows it: of two that
  // race, the first wins.

  /// From QUEUED to RUNNING, or to SUCCEEDED where equal inputs have a result by now.
  std::optional<StoredEvent> mark_running(std::int64_t id, Microseconds now, const ResultKey& key);
  /// From RUNNING, as a further attempt.
  std::optional<StoredEvent> mark_queued(std::int64_t id, Microseconds now,
                                         const std::string& reason);
  std::optional<StoredEvent> mark_cancelled(std::int64_t id, Microseconds now,
                                            const CallLimits& limits = {});
  std::optional<StoredEvent> mark_failed(std::int64_t id, Microseconds now,
                                         const std::string& reason, const std::string& message);
  /// From RUNNING. Equal inputs may have a result by now; if it is another one, then this
  /// simulation is FAILED, unless that one is damaged: then this one takes its place.
  std::optional<StoredEvent> mark_succeeded(std::int64_t id, Microseconds now,
                                            const NewResult& result);

  /// After a crash: RUNNING becomes QUEUED, or FAILED after kMaximumLostAttempts of them. All that
  /// are QUEUED then, oldest first.
  std::vector<Waiting> requeue_unfinished(Microseconds now);

  // Results and histories are compared with their checksums: the calls that read them throw
  // StoreError kDataLoss if stored bytes are not what was written.

  /// Serialised SimulationResult with the assumptions of this simulation.
  std::optional<std::string> result(std::int64_t id, const CallLimits& limits = {});
  HistoryShape history_shape(std::int64_t id, const CallLimits& limits = {});
  /// Doubles [start, start + values.size()) of a level (pyramid.h) of a column; false when the
  /// column is gone.
  bool read_history(std::int64_t column, int level, std::int64_t start, std::span<double> values,
                    const CallLimits& limits = {});
  /// Rows [start, start + count) of one column.
  std::vector<double> history_rows(std::int64_t id, const std::string& column, std::int64_t start,
                                   std::int64_t count);

 private:
  void open_schema();
  void require_place() const;
  /// Changes the row of resources only if `present` is what is there.
  template <class Change>
  bool change(const CallLimits& limits, const StoredResource& present, const Change& change);
  /// In one transaction, which an empty event undoes.
  template <class Change>
  std::optional<StoredEvent> change_simulation(const CallLimits& limits, const Change& change);
  template <class Action>
  auto write(const CallLimits& limits, const Action& action);
  /// In a transaction that it may share with others.
  void write_together(const CallLimits& limits, const GroupCommit::Action& action);
  template <class Action>
  auto read(const CallLimits& limits, const Action& action);

  const std::filesystem::path path_;
  DatabaseLock lock_;
  std::mutex writer_mutex_;
  Connection writer_;  // guarded by writer_mutex_
  GroupCommit group_commit_;
  ReaderPool readers_;
  std::optional<std::filesystem::path> migration_backup_;
  std::optional<DatabaseFiles> files_;  // set by the constructor, once the files exist
};

}  // namespace tribodyn::server
