#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "server/support/observers.h"

namespace tribodyn::server {

/// Progress of a running simulation.
struct Progress {
  double fraction = 0;                      ///< [0, 1]
  std::string stage;                        ///< e.g. "settling at 65 km/h"
  std::optional<double> remaining_seconds;  ///< estimate
};

/// The latest event number and progress of one simulation. The store keeps events; nothing keeps
/// progress. A slow observer sees only the latest values, so that no queue grows. Safe for
/// concurrent access without external synchronization.
class ProgressChannel {
 public:
  /// Publishes a change of state. Ignores a number that is not larger than the latest.
  void publish_event(std::int64_t sequence);
  /// Publishes progress since the latest event. The fraction never falls.
  void publish_progress(Progress progress);

  struct Latest {
    std::int64_t sequence = 0;          ///< of the latest event; 0: none was published
    std::uint64_t progress_number = 0;  ///< grows with each publication of progress
    Progress progress;                  ///< since that event
  };
  Latest latest() const;
  /// Returns Latest::progress_number without a lock.
  std::uint64_t progress_number() const { return progress_number_; }

  /// Notifies the observer of later publications until it is destroyed.
  void observe(const std::weak_ptr<Observer>& observer) { observers_.add(observer); }

 private:
  mutable std::mutex mutex_;
  Latest latest_;                                   // guarded by mutex_
  std::atomic<std::uint64_t> progress_number_ = 0;  // that of latest_
  Observers observers_;
};

/// The channels of all simulations that have not ended. Safe for concurrent access without external
/// synchronization.
class ProgressBoard {
 public:
  /// Returns the channel of a simulation, and creates it if there is none.
  std::shared_ptr<ProgressChannel> open(std::int64_t id);
  /// Returns the channel of a simulation; null if there is none.
  std::shared_ptr<ProgressChannel> find(std::int64_t id) const;
  /// Publishes the last event and removes the channel. Observers of the channel are notified.
  void finish(std::int64_t id, std::int64_t sequence);

 private:
  mutable std::mutex mutex_;
  std::map<std::int64_t, std::shared_ptr<ProgressChannel>> channels_;  // guarded by mutex_
};

}  // namespace tribodyn::server
