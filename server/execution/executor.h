#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/scheduling/scheduler.h"
#include "server/simulation/compute.h"
#include "server/simulation/prepared_gear_sets.h"

namespace tribodyn::server {

/// Threads of this process that take leases and compute them. It reads no row of the store: a lease
/// brings all that its task needs. What was computed is handed to as many other threads, which
/// complete the leases, so that those that compute go on to the next job at once. At the points
/// where a study reports its progress, its thread runs urgent jobs of the scheduler
/// (Scheduler::claim_beside) and then goes on. `start` and `join` from one thread.
class Executor {
 public:
  /// Scheduler and metrics must outlive the object.
  Executor(Scheduler& scheduler, Metrics& metrics, int threads, StudyFunctions studies);
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  /// Proves the golden case, enrolls and starts the threads. Returns what is wrong with the proof;
  /// then nothing is started.
  std::string start();
  /// Waits until the threads have ended, after Scheduler::stop. What was computed is completed
  /// before.
  void join();

 private:
  class Reporter;
  struct Computed {
    Lease lease;
    internal::v1::ComputeResult result;
  };

  void compute_all();
  void complete_all();
  /// Returns the processor time used [s]. `may_lend`: other jobs may run at its points.
  double run(Lease lease, bool may_lend);

  Scheduler& scheduler_;
  Metrics& metrics_;
  const int thread_count_;
  const StudyFunctions studies_;
  PreparedGearSets gear_sets_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Computed> computed_;  // guarded by mutex_
  bool all_computed_ = false;      // guarded by mutex_
  std::vector<std::thread> threads_;
  std::vector<std::thread> completers_;
};

}  // namespace tribodyn::server
