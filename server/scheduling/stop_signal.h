#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace tribodyn::server {

enum class StopReason {
  kNone,
  kEnded,      ///< the simulation has ended otherwise, or the lease is lost
  kShutdown,   ///< the server stops
  kReclassed,  ///< it outran its estimate beside another job and goes back to the queue
};

/// Asks one running job to stop. Safe for concurrent access; the first reason stays.
class StopSignal {
 public:
  void request(StopReason reason);
  StopReason reason() const { return reason_.load(); }
  bool requested() const { return reason() != StopReason::kNone; }
  /// Returns false as soon as the signal comes, true after the time.
  bool wait_for(std::chrono::milliseconds time) const;

 private:
  std::atomic<StopReason> reason_{StopReason::kNone};
  mutable std::mutex mutex_;
  mutable std::condition_variable requested_;
};

}  // namespace tribodyn::server
