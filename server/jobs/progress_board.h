#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/store/store.h"

namespace tribodyn::server {

/// What a watcher sees of a simulation.
struct Progress {
  StoredState state = StoredState::kQueued;
  double fraction = 0;
  std::string stage;  ///< e.g. "settling at 65 km/h"
  std::string error_reason;
  std::string error_message;
};

/// Told that something changed; looks for itself what. Called on any thread, with no lock held;
/// must be quick and must not throw.
class ProgressObserver {
 public:
  virtual ~ProgressObserver() = default;
  virtual void changed() = 0;
};

/// The latest progress of one simulation; whoever is late sees the latest only, so nothing piles
/// up. Safe for concurrent access without external synchronization.
class ProgressChannel {
 public:
  explicit ProgressChannel(Progress initial) : latest_(std::move(initial)) {}

  /// Replaces the latest. While the state stays the fraction never falls; after an end nothing
  /// changes any more.
  void publish(Progress progress);

  struct Numbered {
    std::uint64_t number = 0;  ///< grows with each publication; the first is 1
    Progress progress;
  };
  Numbered latest() const;

  /// The observer is told of later publications for as long as it lives.
  void observe(const std::weak_ptr<ProgressObserver>& observer);

 private:
  mutable std::mutex mutex_;
  Progress latest_;                                         // guarded by mutex_
  std::uint64_t number_ = 1;                                // guarded by mutex_
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
  /// Publishes the end and drops the channel; who holds it still sees the end.
  void finish(std::int64_t id, Progress end);

 private:
  mutable std::mutex mutex_;
  std::map<std::int64_t, std::shared_ptr<ProgressChannel>> channels_;  // guarded by mutex_
};

}  // namespace tribodyn::server
