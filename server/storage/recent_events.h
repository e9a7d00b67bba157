#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "server/storage/stored_simulation.h"

namespace tribodyn::server {

/// The latest events of each project, and the states of simulations that were watched, in memory:
/// the first watch that needs the events of a commit reads them from the database, and the other
/// watches of the project copy them. Safe for concurrent access.
class RecentEvents {
 public:
  static constexpr std::size_t kKept = 500;     ///< events of a project; some 150 bytes each
  static constexpr std::size_t kStates = 2000;  ///< of a project; some 100 bytes each
  static constexpr std::size_t kProjects = 50;  ///< the project read longest ago is dropped

  /// Marks the events in memory as out of date. Called after each transaction, failed ones
  /// included, before anybody is notified of its changes.
  void note_change() { ++changes_; }
  /// Returns a number that grows with each change.
  std::uint64_t changes() const { return changes_; }

  using States = std::vector<std::optional<SimulationState>>;

  /// How to read the database about one project. All functions may throw.
  struct Source {
    /// Returns the first events after a number.
    std::function<EventPage(std::int64_t after)> events;
    /// Returns the number of the latest event.
    std::function<std::int64_t()> latest;
    /// Returns the states of the simulations with these numbers; nullopt for one that is not there.
    std::function<States(const std::vector<std::int64_t>& numbers)> states;
  };

  /// Returns all events of a project after number `after`. Returns nullopt if the memory does not
  /// reach back to that number. Throws what the source throws.
  std::optional<EventPage> after(const std::string& project, std::int64_t after,
                                 const Source& source);
  /// Returns the states of simulations of a project, in the order of `numbers`. Throws what the
  /// source throws.
  States states(const std::string& project, const std::vector<std::int64_t>& numbers,
                const Source& source);

 private:
  struct Project {
    std::deque<StoredEvent> events;
    std::unordered_map<std::int64_t, SimulationState> states;  ///< by number
    std::int64_t forgotten = 0;  ///< events up to this number are not in memory
    std::int64_t latest = 0;
    std::uint64_t changes = 0;  ///< value of changes_ before the last look at the database
    std::uint64_t last_use = 0;
  };

  Project& renewed(const std::string& project, const Source& source);
  Project& entry(const std::string& project, const Source& source);
  static void renew(Project& project, const Source& source);
  static void add(Project& project, const StoredEvent& event);

  std::atomic<std::uint64_t> changes_ = 1;
  std::mutex mutex_;
  std::map<std::string, Project> projects_;  // guarded by mutex_
  std::uint64_t uses_ = 0;                   // guarded by mutex_
};

}  // namespace tribodyn::server
