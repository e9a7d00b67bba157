#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/execution/executor.h"
#include "server/metrics/metrics.h"
#include "server/scheduling/janitor.h"
#include "server/scheduling/progress_board.h"
#include "server/scheduling/scheduler.h"
#include "server/storage/store.h"

namespace tribodyn::server {

/// The life of simulations, as the application sees it: the scheduler, the executor of this
/// process, and what both need. Safe for concurrent access without external synchronization;
/// `resume`, `start`, `drain` and `stop` from one thread.
///
/// What a simulation reads and writes between its request and its result: a request that makes
/// inputs reads its four resources, and its request_id if it has one. One commit writes the row
/// (admit), and the answer is read in the same transaction. The inputs stay in memory, so that the
/// start reads nothing: one commit makes it RUNNING, so that a crash knows which attempts it
/// interrupted, and looks for a result of equal inputs. One commit writes the result with
/// SUCCEEDED. Commits at the same time share one write to disk (GroupCommit).
class SimulationJobs {
 public:
  struct Options {
    int threads = 1;
    QueueLimits limits;
    Retention retention = {};
    Clock clock = system_time;
    StudyFunctions studies;
    /// A watch that has been silent for so long sends a sign of life.
    std::chrono::milliseconds heartbeat = std::chrono::seconds(15);
    /// The executor proves the golden case before its first lease; with made-up studies it cannot.
    bool wants_proof = true;
  };

  /// The store must outlive the object.
  SimulationJobs(Store& store, Options options);
  ~SimulationJobs();
  SimulationJobs(const SimulationJobs&) = delete;
  SimulationJobs& operator=(const SimulationJobs&) = delete;

  /// Queues again what a crash or a stop left unfinished; how many. Before anything is submitted.
  std::size_t resume() { return scheduler_.resume(); }
  /// Until then simulations are accepted but wait. Returns what is wrong if this machine does not
  /// compute the golden case as it should; then nothing is computed.
  std::string start();

  using Submitted = Scheduler::Admitted;
  /// As Scheduler::admit.
  Submitted submit(const NewSimulation& simulation,
                   std::shared_ptr<const SimulationInputs> inputs = nullptr,
                   const CallLimits& limits = {}) {
    return scheduler_.admit(simulation, std::move(inputs), limits);
  }
  /// As Scheduler::ensure_queued.
  void ensure_queued(const StoredSimulation& simulation) { scheduler_.ensure_queued(simulation); }
  /// As Scheduler::cancel.
  std::optional<StoredEvent> cancel(std::int64_t id, const CallLimits& limits = {}) {
    return scheduler_.cancel(id, limits);
  }

  /// Latest progress of a simulation that runs.
  std::optional<Progress> progress(std::int64_t id) const;

  /// The channel of a simulation and how things stood when the channel was open already: whatever
  /// happens after that is heard on it.
  struct Watched {
    std::shared_ptr<ProgressChannel> channel;
    StoredSimulation simulation;
  };
  /// Nothing when there is no such simulation.
  std::optional<Watched> watch(std::int64_t id, const CallLimits& limits = {});
  /// Wakes the observer often enough for heartbeats.
  void wake(const std::weak_ptr<ProgressObserver>& observer) { scheduler_.wake(observer); }
  const Retention& retention() const { return retention_; }
  Metrics& metrics() { return metrics_; }
  Occupancy occupancy() const { return scheduler_.occupancy(); }
  /// Deadlines of simulations that have not ended.
  std::size_t deadlines() const { return scheduler_.deadlines(); }
  std::chrono::milliseconds heartbeat() const { return heartbeat_; }

  /// True once nothing more is accepted.
  bool is_stopping() const { return scheduler_.is_stopping(); }
  /// As Scheduler::drain.
  bool drain(std::chrono::milliseconds limit, const std::function<bool()>& give_up) {
    return scheduler_.drain(limit, give_up);
  }
  /// Running simulations stop and go back to QUEUED in the store.
  void stop();

 private:
  Store& store_;
  const std::chrono::milliseconds heartbeat_;
  Metrics metrics_;
  ProgressBoard board_;
  const Retention retention_;
  Janitor janitor_;
  Scheduler scheduler_;
  Executor executor_;
};

}  // namespace tribodyn::server
