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

/// What an executor tells of itself when it enrolls.
struct Capabilities {
  std::string platform;  ///< of its results (result_key.h): processor, compiler, libraries
  int threads = 1;
};

/// The right of an executor to compute one attempt of a simulation, or a slice of a campaign.
struct Lease {
  std::int64_t id = 0;    ///< row of the simulation, or campaign_part_id()
  std::string name = {};  ///< of the simulation, for log lines
  int attempt = 1;
  internal::v1::ComputeTask task;
  std::shared_ptr<StopSignal> stop;
  std::shared_ptr<ProgressChannel> channel;
};

/// Keeps the state of every simulation from its admission to its end. The scheduler computes
/// nothing and owns no thread that computes: executors enroll, claim a lease, extend it while they
/// compute, and complete it. The store is the only truth, and resume() derives from it what the
/// scheduler keeps in memory. Every failure of a simulation is written to the store. If the store
/// cannot be written (disk full), the scheduler tries again until it can or the server stops. Safe
/// for concurrent access without external synchronization; `resume`, `drain` and `stop` from one
/// thread.
class Scheduler {
 public:
  struct Options {
    QueueLimits limits;
    Clock clock = system_time;
    /// Duration of a lease. After it without extend() the scheduler gives the job to another
    /// executor.
    std::chrono::seconds lease = std::chrono::seconds(60);
    /// Clock of leases and turns, which does not jump as wall clocks do.
    std::function<std::chrono::steady_clock::time_point()> steady = std::chrono::steady_clock::now;
    /// Interval of the checks of leases and of the calls of observers (wake).
    std::chrono::milliseconds tick = std::chrono::seconds(1);
    /// Executors must prove the golden case (golden_case.h).
    bool wants_proof = true;
  };

  /// Store, board and metrics must outlive the object.
  Scheduler(Store& store, ProgressBoard& board, Metrics& metrics, Options options);
  ~Scheduler();
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  /// Queues the simulations that a crash or a stop left unfinished. Returns their number. Must be
  /// called before admit().
  std::size_t resume();

  /// Writes a simulation to the store and queues it, unless its request_id exists or equal inputs
  /// have a result. If the queue has no place for it, writes nothing and returns a retry delay. The
  /// scheduler keeps `inputs` for the lease; without them, or without room, claim() reads them from
  /// the store.
  struct Admitted {
    AddOutcome added;
    double retry_seconds = 0;
  };
  /// `may_wait` = false: as if the queue had no place.
  Admitted admit(const NewSimulation& simulation, std::shared_ptr<const SimulationInputs> inputs,
                 const CallLimits& limits = {}, bool may_wait = true);
  /// Returns the estimate of the simulations of a principal that wait and run [s of one processor].
  double unfinished_seconds(const std::string& principal) const;
  /// Queues a simulation that is QUEUED in the store, if it is not in the queue: a commit may
  /// succeed although its writer sees an error.
  void ensure_queued(const StoredSimulation& simulation);
  /// Marks a simulation CANCELLED in the store and asks its executor to stop. Returns the change of
  /// state. Returns nullopt, and changes nothing, if the simulation has ended.
  std::optional<StoredEvent> cancel(std::int64_t id, const CallLimits& limits = {});

  /// Queues a part of a campaign for a slice: a time of about kSliceSeconds, after which the part
  /// waits again. Does nothing if it waits or runs.
  void add_part(const CampaignPart& part, const std::string& principal);
  /// Estimate of a slice [s]: a tenth of what somebody notices as a delay, and fifty times what the
  /// claim of a slice takes.
  static constexpr double kSliceSeconds = 0.05;

  // Executors call these functions.

  /// Computes the golden case with `compute`. If the result is right, the executor may claim
  /// leases, and an empty text is returned; otherwise a sentence that says what is wrong.
  std::string enroll(
      const std::string& worker, const Capabilities& capabilities,
      const std::function<internal::v1::ComputeResult(const internal::v1::ComputeTask&)>& compute);
  /// Waits until claim() may return a lease. Returns false once the scheduler stops.
  bool wait_for_work();
  /// Marks the next job RUNNING in the store and returns its lease. Returns nullopt if no job may
  /// begin.
  std::optional<Lease> claim(const std::string& worker);
  /// Like claim(), for a job that runs on the thread of `lender` while that job pauses.
  std::optional<Lease> claim_beside(const std::string& worker, const Lease& lender);
  /// Returns true if claim_beside() may return a lease. Takes no lock.
  bool is_urgent() const { return is_urgent_.load(std::memory_order_relaxed); }
  /// Extends the lease and records the processor time used so far. May request a stop of the lease.
  void extend(const Lease& lease, double used_seconds);
  /// Ends the slice of a campaign and charges its principal. The part waits for its next slice if
  /// it `goes_on`.
  void return_slice(const Lease& lease, double used_seconds, bool goes_on);
  /// Frees the thread of the job, whose lease no longer expires. The executor must call complete()
  /// next.
  void computed(const Lease& lease, const internal::v1::ComputeResult& result);
  /// Ends a lease: writes the result, the failure or the stop to the store.
  void complete(const Lease& lease, internal::v1::ComputeResult result);
  /// Queues the jobs again whose lease has expired.
  void expire_leases();

  Occupancy occupancy() const;
  std::size_t deadlines() const { return timekeeper_.deadlines(); }
  /// Notifies the observer every tick until it is destroyed.
  void wake(const std::weak_ptr<Observer>& observer) { timekeeper_.observe(observer); }

  /// Returns true after drain() or stop(): no simulation is accepted and no job begins.
  bool is_stopping() const;
  /// Lets no further job begin, and waits for the running ones until `limit` or until `give_up`
  /// returns true. Returns true if no job runs any more.
  bool drain(std::chrono::milliseconds limit, const std::function<bool()>& give_up);
  /// Lets no further job begin, and asks the running ones to stop: complete() marks them QUEUED.
  /// Deadlines and leases no longer expire.
  void stop();

 private:
  using SteadyTime = std::chrono::steady_clock::time_point;
  /// What the scheduler keeps of a waiting simulation for its lease.
  struct Known {
    std::shared_ptr<const SimulationInputs> inputs;  ///< null: load() reads all from the store
    std::size_t bytes = 0;
    std::string project;
    std::string input_hash;
    bool is_forced = false;
    std::string request_id;
    std::string name;
    Microseconds create_time = 0;
  };
  struct Leased {
    int attempt = 1;
    std::shared_ptr<StopSignal> stop;
    SteadyTime expires;
    SteadyTime written;  ///< when the expiry was last written to the store
    bool is_computed = false;
    std::string request_id;
    std::string name;
    double waited_seconds = 0;
    SteadyTime begin;
  };

  /// Runs the action and marks the simulation FAILED if it throws. Returns false if the store
  /// cannot be written.
  bool run_or_fail(const Lease& lease, const std::function<void()>& action);
  std::optional<Lease> lease_of(const QueuedJob& job, const std::string& worker,
                                const std::string& platform);
  std::optional<Lease> start(const Known& known, Lease lease, const std::string& worker,
                             const std::string& platform);
  std::optional<Lease> begin(const std::string& worker, const Lease* lender, bool& has_begun);
  static Known known_of(const StoredSimulation& stored,
                        std::shared_ptr<const SimulationInputs> inputs);
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
  void end(std::int64_t id, bool goes_back);
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
