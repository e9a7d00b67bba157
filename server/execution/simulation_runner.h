#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "server/contract/resource_names.h"
#include "server/metrics/metrics.h"
#include "server/scheduling/held_keys.h"
#include "server/scheduling/job_queue.h"
#include "server/scheduling/progress_board.h"
#include "server/simulation/compute.h"
#include "server/simulation/prepared_gear_sets.h"
#include "server/storage/store.h"

namespace tribodyn::server {

/// Wall-clock time for records.
using Clock = std::function<Microseconds()>;

/// Carries one simulation from QUEUED to its end: inputs from the store, the study in the core, the
/// result back into the store, progress on the board. Whatever goes wrong ends in the store, never
/// in the thread; a store that cannot be written (disk full) is tried until it can or the server
/// stops. Writing the result down is left as the rest of the job. Safe for concurrent access
/// without external synchronization.
class SimulationRunner {
 public:
  SimulationRunner(Store& store, ProgressBoard& board, Metrics& metrics, Clock clock,
                   StudyFunctions studies);

  void run(std::int64_t id, const StopSignal& stop, JobQueue::Rest& rest) const;

 private:
  /// What is computed, and not yet to be found in the store.
  struct Unwritten {
    StoredSimulation simulation;
    SimulationInputs inputs;
    ResultKey key;
    Solved solved;
    double waited_seconds = 0;
    double computed_seconds = 0;
    HeldKeys::Hold hold;
  };

  template <class Action>
  void guarded(std::int64_t id, const StopSignal& stop, const Action& action) const;
  std::shared_ptr<Unwritten> compute(std::int64_t id, const StopSignal& stop) const;
  void save(Unwritten& unwritten, const StopSignal& stop) const;
  StoredSimulation stored(std::int64_t id, const StopSignal& stop) const;
  SimulationInputs inputs_of(const StoredSimulation& simulation, const StopSignal& stop) const;
  Solved solve_timed(const SimulationInputs& inputs, const ReportProgress& report) const;
  void wait_until_written(const ResultKey& key, const StopSignal& stop) const;
  void publish(std::int64_t id, const std::optional<StoredEvent>& event) const;
  void stopped(std::int64_t id, const StopSignal& stop) const;
  void fail(std::int64_t id, const StopSignal& stop, const std::string& reason,
            const std::string& message) const;
  /// FAILED with INTERNAL. Logs the cause; clients are only referred to the log.
  void fail_on_defect(std::int64_t id, const StopSignal& stop, const char* cause) const;
  template <class Action>
  auto insist(std::int64_t id, const StopSignal& stop, const Action& action) const;

  Store& store_;
  ProgressBoard& board_;
  Metrics& metrics_;
  Clock clock_;
  StudyFunctions studies_;
  mutable HeldKeys unwritten_;
  mutable PreparedGearSets gear_sets_;
};

}  // namespace tribodyn::server
