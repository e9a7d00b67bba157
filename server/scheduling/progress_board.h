#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tribodyn::server {

/// How far a simulation that runs is.
struct Progress {
  double fraction = 0;                      ///< [0, 1]
  std::string stage;                        ///< e.g. "settling at 65 km/h"
  std::optional<double> remaining_seconds;  ///< a guess
};

/// Told that something changed; looks for itself what. Called on any thread, with no lock held;
/// must be quick and must not throw.
class ProgressObserver {
 public:
  virtual ~ProgressObserver() = default;
  virtual void changed() = 0;
};

/// The news of one simulation: the number of its latest event, which the store has, and the latest
/// progress, which nothing keeps. Whoever is late sees the latest only, so nothing piles up. Safe
/// for concurrent access without external synchronization.
class ProgressChannel {
 public:
  /// A change of state: of this number, or of a later one already.
  void publish_event(std::int64_t sequence);
  /// Progress since the latest event; the fraction never falls.
  void publish_progress(Progress progress);

  struct Latest {
    std::int64_t sequence = 0;          ///< of the latest event; 0 when none came yet
    std::uint64_t progress_number = 0;  ///< grows with each publication of progress
    Progress progress;                  ///< since that event
  };
  Latest latest() const;

  /// The observer is told of later publications for as long as it lives.
  void observe(const std::weak_ptr<ProgressObserver>& observer);

 private:
  std::vector<std::shared_ptr<ProgressObserver>> living_observers() const;

  mutable std::mutex mutex_;
  Latest latest_;                                           // guarded by mutex_
  std::vector<std::weak_ptr<ProgressObserver>> observers_;  // guarded by mutex_
};

/// The channels of all simulations that have not ended.
/// Safe for concurrent access without external synchronization.
class ProgressBoard {
 public:
  /// The channel of a simulation, made when there is none.
  std::shared_ptr<ProgressChannel> open(std::int64_t id);
  /// The same, or null.
  std::shared_ptr<ProgressChannel> find(std::int64_t id) const;
  /// Publishes the last event and drops the channel; who holds it still hears of it.
  void finish(std::int64_t id, std::int64_t sequence);

 private:
  mutable std::mutex mutex_;
  std::map<std::int64_t, std::shared_ptr<ProgressChannel>> channels_;  // guarded by mutex_
};

}  // namespace tribodyn::server
