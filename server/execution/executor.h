#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/execution/campaign_jobs.h"
#include "server/scheduling/scheduler.h"
#include "server/simulation/compute.h"
#include "server/simulation/prepared_gear_sets.h"

namespace tribodyn::server {

/// Threads of this process that claim leases and compute them. The executor reads no row of the
/// store, because a lease contains all that its task needs. As many other threads complete the
/// leases, so that the computing ones begin the next job at once; one more completes those without
/// a history, because the writing of a long history takes seconds. A slice of a campaign writes its
/// own tiles. Where a study reports its
/// progress, its thread may run one urgent job (Scheduler::claim_beside) before it continues.
/// `start` and `join` from one thread.
class Executor {
 public:
  /// Scheduler, campaigns and metrics must outlive the object.
  Executor(Scheduler& scheduler, CampaignJobs& campaigns, Metrics& metrics, int threads,
           StudyFunctions studies);
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  /// Computes the golden case, enrolls and starts the threads. If the result is wrong, starts
  /// nothing and returns a sentence that says what is wrong.
  std::string start();
  /// Waits until the threads have ended and have completed what they computed. Requires
  /// Scheduler::stop() before.
  void join();

 private:
  class Reporter;
  struct Computed {
    Lease lease;
    internal::v1::ComputeResult result;
  };

  void compute_all();
  void complete_all(bool takes_histories);
  /// Computes a lease. `may_lend`: urgent jobs may run where the study reports its progress.
  void run(Lease lease, bool may_lend);
  void run_simulation(Lease lease, bool may_lend);
  void run_slice(const Lease& lease, bool may_lend);

  Scheduler& scheduler_;
  CampaignJobs& campaigns_;
  Metrics& metrics_;
  const int thread_count_;
  const StudyFunctions studies_;
  PreparedGearSets gear_sets_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Computed> small_;  // guarded by mutex_; results without a history
  std::deque<Computed> large_;  // guarded by mutex_; results with one
  bool all_computed_ = false;   // guarded by mutex_
  std::vector<std::thread> threads_;
  std::vector<std::thread> completers_;
};

}  // namespace tribodyn::server
