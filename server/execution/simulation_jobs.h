#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/execution/campaign_jobs.h"
#include "server/execution/executor.h"
#include "server/metrics/metrics.h"
#include "server/scheduling/janitor.h"
#include "server/scheduling/progress_board.h"
#include "server/scheduling/scheduler.h"
#include "server/storage/store.h"

namespace tribodyn::server {

/// The application's interface to simulations and campaigns: owns the scheduler, the executor of
/// this process and what both need. Safe for concurrent access without external synchronization;
/// `resume`, `start`, `drain` and `stop` from one thread.
///
/// Reads and commits between a request and its result: the use case reads the four resources, and
/// the request_id if there is one. The first commit looks for the request_id again and for a result
/// of equal inputs, and writes the row (admit), of which the answer is made. The scheduler keeps
/// the inputs, so the start of the job reads nothing; the second commit looks for a result of equal
/// inputs and marks the job RUNNING, so that a start after a crash knows which attempts were
/// interrupted. The third commit writes the result and SUCCEEDED. Concurrent commits share one
/// write to disk (GroupCommit).
class SimulationJobs {
 public:
  struct Options {
    int threads = 1;
    QueueLimits limits;
    Retention retention = {};
    Clock clock = system_time;
    StudyFunctions studies;
    /// Interval of the heartbeats of a silent watch.
    std::chrono::milliseconds heartbeat = std::chrono::seconds(15);
    /// The executor must compute the golden case. Tests with invented studies set false.
    bool wants_proof = true;
  };

  /// The store must outlive the object.
  SimulationJobs(Store& store, Options options);
  ~SimulationJobs();
  SimulationJobs(const SimulationJobs&) = delete;
  SimulationJobs& operator=(const SimulationJobs&) = delete;

  /// As Scheduler::resume and CampaignJobs::resume.
  std::size_t resume() { return scheduler_.resume() + campaigns_.resume(); }
  /// Starts the executor; before it, simulations are accepted and wait. If this machine computes a
  /// wrong golden case, starts nothing and returns a sentence that says what is wrong.
  std::string start();

  /// Admits, queues and cancels simulations.
  Scheduler& scheduler() { return scheduler_; }
  /// Returns the estimate of the simulations and campaigns of a principal that wait and run [s of
  /// one processor].
  double unfinished_seconds(const std::string& principal) const {
    return scheduler_.unfinished_seconds(principal) + campaigns_.unfinished_seconds(principal);
  }

  /// Returns the latest progress of a running simulation; nullopt if it does not run.
  std::optional<Progress> progress(std::int64_t id) const;

  /// The channel of a simulation, and its row as read after the channel was opened: the channel
  /// reports every later change.
  struct Watched {
    std::shared_ptr<ProgressChannel> channel;
    StoredSimulation simulation;
  };
  /// Returns nullopt if there is no such simulation.
  std::optional<Watched> watch(std::int64_t id, const CallLimits& limits = {});
  /// The same of many simulations of a project, in the order of their numbers.
  struct WatchedStates {
    std::vector<std::optional<SimulationState>> states;  ///< nullopt: there is no such simulation
    std::vector<std::shared_ptr<ProgressChannel>> channels;  ///< null unless it is unfinished
  };
  WatchedStates watch(const std::string& project, const std::vector<std::int64_t>& numbers,
                      const CallLimits& limits = {});
  /// Returns the channel of a simulation; null if it has ended, or has none yet.
  std::shared_ptr<ProgressChannel> channel(std::int64_t id) const { return board_.find(id); }
  const QueueLimits& limits() const { return limits_; }
  const Retention& retention() const { return retention_; }
  CampaignJobs& campaigns() { return campaigns_; }
  Metrics& metrics() { return metrics_; }
  std::chrono::milliseconds heartbeat() const { return heartbeat_; }

  /// Stops the running simulations, which become QUEUED in the store, and ends all threads.
  void stop();

 private:
  Store& store_;
  const std::chrono::milliseconds heartbeat_;
  Metrics metrics_;
  ProgressBoard board_;
  const QueueLimits limits_;
  const Retention retention_;
  Janitor janitor_;
  Scheduler scheduler_;
  CampaignJobs campaigns_;
  Executor executor_;
};

}  // namespace tribodyn::server
