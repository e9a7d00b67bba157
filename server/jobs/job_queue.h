#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace tribodyn::server {

enum class StopReason { kNone, kCancelled, kShutdown };

/// Asks one running job to stop. Safe for concurrent access; the first reason stays.
class StopSignal {
 public:
  void request(StopReason reason) {
    StopReason none = StopReason::kNone;
    reason_.compare_exchange_strong(none, reason);
  }
  StopReason reason() const { return reason_.load(); }
  bool requested() const { return reason() != StopReason::kNone; }

 private:
  std::atomic<StopReason> reason_{StopReason::kNone};
};

/// Threads that work through jobs, first come first served; a job is a number and what it means is
/// the caller's. Safe for concurrent access without external synchronization; `stop` and the
/// destructor from one thread.
class JobQueue {
 public:
  /// Called on a worker's thread; must not throw (what it throws is swallowed).
  using Work = std::function<void(std::int64_t id, const StopSignal& stop)>;

  JobQueue(int threads, std::size_t maximum_waiting, Work work);
  ~JobQueue();
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// A place among the waiting, before the job is written down anywhere; false when all are taken.
  bool reserve();
  void release();                      ///< gives a reserved place back
  void push(std::int64_t id);          ///< takes the reserved place
  void push_resumed(std::int64_t id);  ///< beyond the limit: jobs that a former run accepted

  /// A waiting job is dropped, a running one is signalled; others are left alone.
  void cancel(std::int64_t id);

  /// No further job starts; running ones are signalled with kShutdown and waited for.
  void stop();

 private:
  void run();
  void enqueue(std::int64_t id);

  const std::size_t maximum_waiting_;
  const Work work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::int64_t> waiting_;                             // guarded by mutex_
  std::map<std::int64_t, std::shared_ptr<StopSignal>> running_;  // guarded by mutex_
  std::size_t reserved_ = 0;                                     // guarded by mutex_
  bool stopping_ = false;                                        // guarded by mutex_
  std::vector<std::thread> threads_;
};

}  // namespace tribodyn::server
