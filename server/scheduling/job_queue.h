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
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/metrics/metrics.h"
#include "server/scheduling/fair_queue.h"
#include "server/scheduling/turns.h"

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

/// What may wait; of each at most three quarters for one principal, so that others still get in.
struct QueueLimits {
  std::size_t jobs = 20'000;
  double cost_seconds = 360'000;  ///< estimated, of one processor
};

/// Whether a job has a place, and when it is worth asking again if not (Turns).
struct Admission {
  bool is_admitted = false;
  double retry_seconds = 0;
};

/// Threads that work through jobs in the order of a FairQueue; a job is a number and what it means
/// is the caller's. What a job leaves to be done when it is computed, writing its result down, is
/// done by as many other threads, so that those that compute go on to the next one at once. Where
/// several compute, one is kept for interactive jobs. Safe for concurrent access without external
/// synchronization; `start`, `drain`, `stop` and the destructor from one thread.
class JobQueue {
 public:
  /// Both are called on threads of the queue and must not throw (what they throw is swallowed). The
  /// job runs until its rest, if it sets one, is done; `stop` lives as long.
  using Rest = std::function<void()>;
  using Work = std::function<void(std::int64_t id, const StopSignal& stop, Rest& rest)>;

  JobQueue(int threads, const QueueLimits& limits, Work work);
  ~JobQueue();
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// Before it jobs only wait.
  void start();

  /// A place among the waiting, before the job is written down anywhere and has an id.
  Admission reserve(const QueuedJob& job);
  void release(const QueuedJob& job);  ///< gives a reserved place back
  void push(const QueuedJob& job);     ///< takes the reserved place
  /// Beyond the limits: a job that a former run accepted. One that may be what killed it runs
  /// alone, so that it takes no other with it.
  void push_resumed(const QueuedJob& job);

  /// The same, of a job that may be here already; true when it was not.
  bool push_missing(const QueuedJob& job);

  /// How much waits and runs.
  Occupancy occupancy() const;

  /// A job that has ended otherwise: dropped when it waits, signalled when it runs.
  void drop(std::int64_t id);

  bool is_stopping() const;

  /// No further job starts; waits for those that run, so long. True when none runs any more, early
  /// when `give_up` says so.
  bool drain(std::chrono::milliseconds limit, const std::function<bool()>& give_up);

  /// No further job starts; running ones are signalled with kShutdown and waited for.
  void stop();

 private:
  /// Places given out that no job has taken yet.
  struct Reserved {
    std::size_t jobs = 0;
    double cost_seconds = 0;
  };

  struct Running {
    QueuedJob job;
    std::shared_ptr<StopSignal> signal;
    Rest rest;
  };

  void compute();
  void write_down();
  std::optional<Running> next();
  std::optional<Running> next_unwritten();
  void finish_computing(Running computed);
  void end(const QueuedJob& job);
  void join();
  void enqueue(const QueuedJob& job);
  void give_back(const QueuedJob& job);
  Lane last_lane() const;
  bool may_begin() const;

  const int thread_count_;
  const QueueLimits limits_;
  const Work work_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::condition_variable computed_;
  std::condition_variable ended_;
  FairQueue waiting_;                                            // guarded by mutex_
  std::map<std::int64_t, std::shared_ptr<StopSignal>> running_;  // guarded by mutex_
  bool one_runs_alone_ = false;                                  // guarded by mutex_
  std::deque<Running> unwritten_;                                // guarded by mutex_
  bool all_computed_ = false;                                    // guarded by mutex_
  int computing_bulk_ = 0;                                       // guarded by mutex_
  Reserved reserved_;                                            // guarded by mutex_
  std::map<std::string, Reserved> reserved_of_;                  // guarded by mutex_; by principal
  Turns turns_;                                                  // guarded by mutex_
  bool stopping_ = false;                                        // guarded by mutex_
  std::vector<std::thread> threads_;
  std::vector<std::thread> writers_;
};

}  // namespace tribodyn::server
