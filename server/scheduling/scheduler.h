#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/metrics/metrics.h"
#include "server/scheduling/claim_policy.h"
#include "server/scheduling/progress_board.h"
#include "server/scheduling/stop_signal.h"
#include "server/scheduling/timekeeper.h"
#include "server/simulation/compute_task.h"
#include "server/storage/store.h"

namespace tribodyn::server {

/// Wall-clock time for records.
using Clock = std::function<Microseconds()>;

/// What an executor can do.
struct Capabilities {
  std::string platform;  ///< of its results (result_key.h)
  int threads = 1;
};

/// The right and the duty to compute one attempt of a simulation.
struct Lease {
  std::int64_t id = 0;
  int attempt = 1;
  internal::v1::ComputeTask task;
  std::shared_ptr<StopSignal> stop;
  std::shared_ptr<ProgressChannel> channel;
};

/// Carries simulations from admission to their end: which waits, who computes it, what becomes of
/// it. It computes nothing and owns no thread that does: executors enroll, claim a lease, extend it
/// while they compute, and complete it. The store is the only truth; what the scheduler keeps in
/// memory follows from it (resume). Whatever goes wrong with a simulation ends in the store; a
/// store that cannot be written (disk full) is tried again until it can be, or the server stops.
/// Safe for concurrent access without external synchronization; `resume`, `drain` and `stop` from
/// one thread.
class Scheduler {
 public:
  struct Options {
    QueueLimits limits;
    Clock clock = system_time;
    /// What has not ended after so long without a sign of its executor is given to another one.
    std::chrono::seconds lease = std::chrono::seconds(60);
    /// For leases and turns; wall clocks jump.
    std::function<std::chrono::steady_clock::time_point()> steady = std::chrono::steady_clock::now;
    /// How often time is looked at: for leases, and by observers of `wake`.
    std::chrono::milliseconds tick = std::chrono::seconds(1);
    /// Executors must prove the golden case (golden_case.h).
    bool wants_proof = true;
  };

  /// Store, board and metrics must outlive the object.
  Scheduler(Store& store, ProgressBoard& board, Metrics& metrics, Options options);
  ~Scheduler();
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  /// Queues what a crash or a stop left unfinished; returns how many. Before anything is submitted.
  std::size_t resume();

  /// Writes a simulation down, and queues it unless it is there or served already. If it would have
  /// to wait and has no place, says when to ask again. `inputs`: what it was made of; if they are
  /// left out, or there is no room to keep them, they are read from the store when it begins.
  struct Admitted {
    Added added;
    double retry_seconds = 0;
  };
  Admitted admit(const NewSimulation& simulation, std::shared_ptr<const SimulationInputs> inputs,
                 const CallLimits& limits = {});
  /// Queues a simulation that is QUEUED in the store and may not be here: its request may have been
  /// written and yet been answered with an error.
  void ensure_queued(const StoredSimulation& simulation);
  /// At once CANCELLED in the store; its executor stops at the next step. Returns the change of
  /// state; nullopt, and changes nothing, if the simulation has ended before.
  std::optional<StoredEvent> cancel(std::int64_t id, const CallLimits& limits = {});

  // For executors.

  /// Lets an executor claim leases, if `compute` makes of the golden case what it should. Returns
  /// what is wrong; then the executor gets no lease.
  std::string enroll(
      const std::string& worker, const Capabilities& capabilities,
      const std::function<internal::v1::ComputeResult(const internal::v1::ComputeTask&)>& compute);
  /// Waits until claim may return a lease; false once the scheduler stops.
  bool wait_for_work();
  /// The next job, RUNNING in the store; nullopt if none may begin.
  std::optional<Lease> claim(const std::string& worker);
  /// The next job that may run on the thread of `lender`, which goes on afterwards.
  std::optional<Lease> claim_beside(const std::string& worker, const Lease& lender);
  /// Whether claim_beside is worth a try. Takes no lock.
  bool is_urgent() const { return is_urgent_.load(std::memory_order_relaxed); }
  /// Tells that the executor is alive and has used so much of a processor for the job. It may ask
  /// the lease to stop.
  void extend(const Lease& lease, double used_seconds);
  /// The job has left its thread. From now on the lease does not expire; complete() follows.
  void computed(const Lease& lease, const internal::v1::ComputeResult& result);
  /// Writes down what became of a lease: its result, why it failed, or that it was stopped.
  void complete(const Lease& lease, internal::v1::ComputeResult result);
  /// Gives leases whose executor has given no sign for too long to others.
  void expire_leases();

  Occupancy occupancy() const;
  std::size_t deadlines() const { return timekeeper_.deadlines(); }
  /// Wakes the observer every tick.
  void wake(const std::weak_ptr<ProgressObserver>& observer) { timekeeper_.observe(observer); }

  /// True once nothing more is accepted and no job begins.
  bool is_stopping() const;
  /// No further job begins; waits for those that run, so long. True when none runs any more, early
  /// when `give_up` says so.
  bool drain(std::chrono::milliseconds limit, const std::function<bool()>& give_up);
  /// No further job begins, and running ones are asked to stop: as their executors complete them,
  /// they go back to QUEUED. Time is not looked at any more.
  void stop();

 private:
  using SteadyTime = std::chrono::steady_clock::time_point;
  /// What is known of a waiting simulation beside ClaimPolicy.
  struct Known {
    std::shared_ptr<const SimulationInputs> inputs;  ///< null: to be read from the store
    std::size_t bytes = 0;
    std::string input_hash;
    bool is_forced = false;
    std::string request_id;
    Microseconds create_time = 0;
    bool is_loaded = false;  ///< all of the above are known
  };
  struct Leased {
    int attempt = 1;
    std::shared_ptr<StopSignal> stop;
    SteadyTime expires;
    SteadyTime written;  ///< when the store was told last
    bool is_computed = false;
    std::string request_id;
    double waited_seconds = 0;
    SteadyTime begin;
  };

  template <class Action>
  auto insist(std::int64_t id, const StopSignal& stop, const Action& action) const;
  /// Whatever goes wrong ends in the store. Returns false if the store cannot be written.
  template <class Action>
  bool guarded(const Lease& lease, const Action& action);
  std::optional<Lease> lease_of(const QueuedJob& job, const std::string& worker,
                                const std::string& platform);
  std::optional<Lease> start(const Known& known, Lease lease, const std::string& worker,
                             const std::string& platform);
  std::optional<Lease> begin(const std::string& worker, const Lease* lender, bool& has_begun);
  Known load(std::int64_t id, const StopSignal& stop);
  void keep(std::int64_t id, Known known);
  Known take(std::int64_t id);
  void save(const Lease& lease, internal::v1::ComputeResult& result);
  bool stopped(const Lease& lease);
  void fail(const Lease& lease, const std::string& reason, const std::string& message);
  void fail_on_defect(const Lease& lease, const std::string& cause);
  void publish(std::int64_t id, const std::optional<StoredEvent>& event);
  void end_otherwise(std::int64_t id, const std::optional<StoredEvent>& event);
  void expire(std::int64_t id);
  void end(std::int64_t id);
  void requeue(std::int64_t id, bool alone);
  void note_change();
  bool is_current(const Lease& lease) const;

  Store& store_;
  ProgressBoard& board_;
  Metrics& metrics_;
  const Options options_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::condition_variable ended_;
  ClaimPolicy policy_;                            // guarded by mutex_
  std::map<std::int64_t, Known> known_;           // guarded by mutex_
  std::size_t known_bytes_ = 0;                   // guarded by mutex_
  std::map<std::int64_t, Leased> leased_;         // guarded by mutex_
  std::map<std::string, Capabilities> enrolled_;  // guarded by mutex_
  SteadyTime last_look_;                          // guarded by mutex_; of expire_leases
  bool stopping_ = false;                         // guarded by mutex_
  std::atomic<bool> is_urgent_ = false;
  Timekeeper timekeeper_;  // last: its thread uses all of the above
};

}  // namespace tribodyn::server
