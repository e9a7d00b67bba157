#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace tribodyn::server {

enum class StopReason {
  kNone,
  kEnded,      ///< the simulation was cancelled, its deadline has passed, or the lease has expired
  kShutdown,   ///< the server stops
  kReclassed,  ///< the job used more than its allowed time on a lent thread
};

/// Asks a running job to stop. The first reason stays. Safe for concurrent access without external
/// synchronization.
class StopSignal {
 public:
  void request(StopReason reason);
  StopReason reason() const { return reason_.load(); }
  bool requested() const { return reason() != StopReason::kNone; }
  /// Waits. Returns false as soon as a stop is requested, and true after `time`.
  bool wait_for(std::chrono::milliseconds time) const;

 private:
  std::atomic<StopReason> reason_{StopReason::kNone};
  mutable std::mutex mutex_;
  mutable std::condition_variable requested_;
};

}  // namespace tribodyn::server
