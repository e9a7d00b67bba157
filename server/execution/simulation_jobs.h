#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/execution/simulation_runner.h"
#include "server/metrics/metrics.h"
#include "server/scheduling/janitor.h"
#include "server/scheduling/job_queue.h"
#include "server/scheduling/progress_board.h"
#include "server/scheduling/timekeeper.h"
#include "server/storage/store.h"

namespace tribodyn::server {

/// The life of simulations: accepted, queued, run, cancelled, too late, resumed after a crash.
/// Safe for concurrent access without external synchronization; `resume`, `start`, `drain` and
/// `stop` from one thread.
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
  };

  /// The store must outlive the object.
  SimulationJobs(Store& store, Options options);
  ~SimulationJobs();
  SimulationJobs(const SimulationJobs&) = delete;
  SimulationJobs& operator=(const SimulationJobs&) = delete;

  /// Queues again what a crash or a stop left unfinished; how many. Before anything is submitted.
  std::size_t resume();
  /// Until then simulations are accepted but wait.
  void start();

  /// Writes a simulation down, and queues it unless it is there or served already. Where it would
  /// have to wait and has no place, says when to ask again.
  struct Submitted {
    Added added;
    double retry_seconds = 0;
  };
  Submitted submit(const NewSimulation& simulation, const CallLimits& limits = {});
  /// Of a simulation that is QUEUED in the store: its request may have been written and yet been
  /// answered with an error, before it came into the queue.
  void ensure_queued(const StoredSimulation& simulation);

  /// At once CANCELLED in the store; a worker on it stops at its next step. Returns the change of
  /// state; nullopt, and changes nothing, if the simulation has ended before.
  std::optional<StoredEvent> cancel(std::int64_t id, const CallLimits& limits = {});

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
  void wake(const std::weak_ptr<ProgressObserver>& observer) { timekeeper_.observe(observer); }
  const Retention& retention() const { return retention_; }
  Metrics& metrics() { return metrics_; }
  Occupancy occupancy() const { return queue_.occupancy(); }
  std::chrono::milliseconds heartbeat() const { return heartbeat_; }

  /// True once nothing more is accepted.
  bool is_stopping() const { return queue_.is_stopping(); }
  /// As JobQueue::drain.
  bool drain(std::chrono::milliseconds limit, const std::function<bool()>& give_up);
  /// Running simulations stop and go back to QUEUED in the store.
  void stop();

 private:
  void expire(std::int64_t id);
  void end(std::int64_t id, const std::optional<StoredEvent>& event);

  Store& store_;
  const Clock clock_;
  const std::chrono::milliseconds heartbeat_;
  Metrics metrics_;
  ProgressBoard board_;
  SimulationRunner runner_;
  JobQueue queue_;
  const Retention retention_;
  Janitor janitor_;
  Timekeeper timekeeper_;  // last: its thread uses all of the above
};

}  // namespace tribodyn::server
