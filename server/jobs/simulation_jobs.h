#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "server/jobs/job_queue.h"
#include "server/jobs/progress_board.h"
#include "server/jobs/simulation_runner.h"
#include "server/store/store.h"

namespace tribodyn::server {

inline constexpr std::size_t kMaximumWaitingSimulations = 10'000;

/// The life of simulations: accepted, queued, run, cancelled, resumed after a crash.
/// Safe for concurrent access without external synchronization; `resume` and `stop` from one
/// thread.
class SimulationJobs {
 public:
  struct Options {
    int threads = 1;
    std::size_t maximum_waiting = kMaximumWaitingSimulations;
    Clock clock = system_time;
    StudyFunctions studies;
  };

  /// The store must outlive the object.
  SimulationJobs(Store& store, Options options);

  /// Queues again what a crash or a stop left unfinished; how many.
  std::size_t resume();

  /// Writes a simulation down and queues it; its id, or nothing when too many wait.
  std::optional<std::int64_t> submit(const NewSimulation& simulation);

  /// At once CANCELLED in the store; a worker on it stops at its next step. No effect on what has
  /// ended.
  void cancel(std::int64_t id);

  /// Latest progress of a simulation that has not ended.
  std::optional<Progress> progress(std::int64_t id) const;

  /// A channel that shows the simulation's progress and, sooner or later, its end. Null when there
  /// is no such simulation.
  std::shared_ptr<ProgressChannel> watch(std::int64_t id);

  /// Running simulations stop and go back to QUEUED in the store.
  void stop();

 private:
  Store& store_;
  Clock clock_;
  ProgressBoard board_;
  SimulationRunner runner_;
  JobQueue queue_;  // last: its threads use all of the above
};

}  // namespace tribodyn::server
