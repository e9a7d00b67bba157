#pragma once

#include <atomic>
#include <chrono>
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

enum class StopReason { kNone, kEnded, kShutdown };

/// Asks one running job to stop. Safe for concurrent access; the first reason stays.
class StopSignal {
 public:
  void request(StopReason reason);
  StopReason reason() const { return reason_.load(); }
  bool requested() const { return reason() != StopReason::kNone; }
  /// False as soon as the signal comes, true after the time.
  bool wait_for(std::chrono::milliseconds time) const;

 private:
  std::atomic<StopReason> reason_{StopReason::kNone};
  mutable std::mutex mutex_;
  mutable std::condition_variable requested_;
};

/// Threads that work through jobs, first come first served; a job is a number and what it means is
/// the caller's. Safe for concurrent access without external synchronization; `start`, `drain`,
/// `stop` and the destructor from one thread.
class JobQueue {
 public:
  /// Called on a worker's thread; must not throw (what it throws is swallowed).
  using Work = std::function<void(std::int64_t id, const StopSignal& stop)>;

  JobQueue(int threads, std::size_t maximum_waiting, Work work);
  ~JobQueue();
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// Before it jobs only wait.
  void start();

  /// A place among the waiting, before the job is written down anywhere; false when all are taken.
  bool reserve();
  void release();              ///< gives a reserved place back
  void push(std::int64_t id);  ///< takes the reserved place
  /// Beyond the limit: a job that a former run accepted. One that may be what killed it runs alone,
  /// so that it takes no other with it.
  void push_resumed(std::int64_t id, bool alone = false);

  /// The same, of a job that may be here already; true when it was not.
  bool push_missing(std::int64_t id);

  /// A job that has ended otherwise: dropped when it waits, signalled when it runs.
  void drop(std::int64_t id);

  bool is_stopping() const;

  /// No further job starts; waits for those that run, so long. True when none runs any more, early
  /// when `give_up` says so.
  bool drain(std::chrono::milliseconds limit, const std::function<bool()>& give_up);

  /// No further job starts; running ones are signalled with kShutdown and waited for.
  void stop();

 private:
  struct Waiting {
    std::int64_t id = 0;
    bool alone = false;
  };

  void run();
  void enqueue(const Waiting& job);
  bool may_begin() const;

  const int thread_count_;
  const std::size_t maximum_waiting_;
  const Work work_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::condition_variable ended_;
  std::deque<Waiting> waiting_;                                  // guarded by mutex_
  std::map<std::int64_t, std::shared_ptr<StopSignal>> running_;  // guarded by mutex_
  bool one_runs_alone_ = false;                                  // guarded by mutex_
  std::size_t reserved_ = 0;                                     // guarded by mutex_
  bool stopping_ = false;                                        // guarded by mutex_
  std::vector<std::thread> threads_;
};

}  // namespace tribodyn::server
