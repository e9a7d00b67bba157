#pragma once

#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/store/connections.h"
#include "server/store/database_lock.h"
#include "server/store/store_error.h"
#include "server/store/stored_resource.h"

namespace tribodyn::server {

/// States as on disk; the numbers are those of Simulation.State.
enum class StoredState { kQueued = 1, kRunning = 2, kSucceeded = 3, kFailed = 4, kCancelled = 5 };

/// True when nothing more will happen to the simulation.
inline bool has_ended(StoredState state) { return state >= StoredState::kSucceeded; }

struct StoredSimulation {
  std::int64_t id = 0;
  StoredState state = StoredState::kQueued;
  Microseconds create_time = 0;
  std::optional<Microseconds> start_time;
  std::optional<Microseconds> end_time;
  std::string request;  ///< serialised Simulation
  std::string input_hash;
  std::string error_reason;
  std::string error_message;
  // What it rests on, "lubricants/1@2"; empty where that is not known.
  std::string lubricant_revision;
  std::string gear_set_revision;
  std::string surface_revision;
  std::string vehicle_revision;
};

/// A simulation to be stored.
struct NewSimulation {
  std::string request;  ///< serialised Simulation
  std::string input_hash;
  // Revisions as above; each exists or is empty.
  std::string lubricant_revision = {};
  std::string gear_set_revision = {};
  std::string surface_revision = {};
  std::string vehicle_revision = {};
};

struct StoredColumn {
  std::string name;
  std::vector<double> values;
};

/// Safe for concurrent access without external synchronization: one writer at a time, readers
/// beside it. The only truth about resources, simulations and results (schema.h). A call that
/// changes something returns when the change is on disk. Throws StoreError.
class Store {
 public:
  /// Opens or creates the database and keeps other servers away from it.
  explicit Store(const std::filesystem::path& database);

  /// Adds what is missing in one transaction; what exists, deleted or not, stays as it is.
  void add_resources(const std::vector<NewResource>& resources, Microseconds now);
  /// The present revision, of a deleted resource too.
  std::optional<StoredResource> resource(const std::string& name);
  std::optional<StoredResource> revision(const std::string& name, int revision);
  Page<StoredResource> resources(const ResourceQuery& query);
  /// Newest first, those before `before` (0: from the newest): `limit` rows, or fewer so that they
  /// stay within `byte_limit`, but at least one.
  Page<StoredResource> revisions(const std::string& name, int before, int limit,
                                 std::size_t byte_limit);
  /// All that are not deleted, sorted.
  std::vector<std::string> resource_names(const std::string& collection);

  /// All of them in one transaction; what they are then. Nothing, and nothing is changed, when the
  /// name of a new one is taken, if only by a deleted resource, or a present one has changed since
  /// it was read.
  std::optional<std::vector<StoredResource>> write_resources(
      const std::vector<ResourceWrite>& writes, Microseconds now);
  // Changes of `present`, as it was read. Each returns false, and changes nothing, when the
  // resource has changed since.
  bool delete_resource(const StoredResource& present, Microseconds now);
  bool undelete_resource(const StoredResource& present);

  /// A new simulation, QUEUED; its id.
  std::int64_t add_simulation(const NewSimulation& simulation, Microseconds now);
  std::optional<StoredSimulation> simulation(std::int64_t id);
  /// Newest first, ids below `before` (0: from the newest); limits as of revisions.
  Page<StoredSimulation> simulations(std::int64_t before, int limit, std::size_t byte_limit);

  // Changes of state. Each returns false, and changes nothing, when the simulation is not in a
  // state that allows it: of two that race, the first wins.
  bool mark_running(std::int64_t id, Microseconds now);    ///< from QUEUED
  bool mark_queued(std::int64_t id);                       ///< from RUNNING
  bool mark_cancelled(std::int64_t id, Microseconds now);  ///< from QUEUED or RUNNING
  bool mark_failed(std::int64_t id, Microseconds now, const std::string& reason,
                   const std::string& message);  ///< from QUEUED or RUNNING
  /// From RUNNING; result, history and state in one transaction.
  bool mark_succeeded(std::int64_t id, Microseconds now, const std::string& result,
                      const std::vector<StoredColumn>& history);

  /// After a crash: RUNNING becomes QUEUED. Ids of all that are QUEUED then, oldest first.
  std::vector<std::int64_t> requeue_unfinished();

  std::optional<std::string> result(std::int64_t id);
  /// Names of the stored columns, and how many rows each has.
  struct HistoryShape {
    std::vector<std::string> names;
    std::int64_t rows = 0;
  };
  HistoryShape history_shape(std::int64_t id);
  /// Rows [start, start + count) of one column, read in place.
  std::vector<double> history_rows(std::int64_t id, const std::string& column, std::int64_t start,
                                   std::int64_t count);

 private:
  void open_schema();
  /// Changes the row of resources only if `present` is what is there.
  template <class Change>
  bool change(const StoredResource& present, const Change& change);
  template <class Action>
  auto write(const Action& action);
  template <class Action>
  auto read(const Action& action);

  const std::filesystem::path path_;
  DatabaseLock lock_;
  std::mutex writer_mutex_;
  SQLite::Database writer_;  // guarded by writer_mutex_
  ReaderPool readers_;
};

}  // namespace tribodyn::server
