#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/metrics/metrics.h"
#include "server/scheduling/fair_queue.h"
#include "server/scheduling/pace.h"
#include "server/scheduling/turns.h"

namespace tribodyn::server {

/// Capacity of the queue. One principal may use three quarters of each limit, so that there is room
/// for others.
struct QueueLimits {
  std::size_t jobs = 20'000;
  double cost_seconds = 360'000;  ///< sum of the estimates, in seconds of one processor
  /// Size of the histories of the jobs that run or whose result is not written yet. A job with a
  /// larger history runs while there is no other history.
  std::int64_t unwritten_bytes = 512'000'000;
};

/// Whether a job has a place in the queue, and if not, when the client should ask again (Turns).
struct Admission {
  bool is_admitted = false;
  double retry_seconds = 0;
};

/// Decides which job a claim gets, and keeps account of the jobs that wait and run. It has no
/// clock, thread or store: the caller passes times. Not safe for concurrent access.
///
/// - FairQueue gives the order. If several threads compute, one of them takes no bulk job.
/// - A job that uses more processor time than allowed_seconds() counts as bulk from then on, and
///   its principal is charged for the time used.
/// - If all threads compute, an interactive job runs on the thread of a less urgent job (its
///   lender), which then continues (begin_beside). If all threads compute bulk jobs, a small job
///   does too.
/// - A job on a lent thread that uses more than its allowed time returns to the queue as a bulk
///   job, so that the lender waits for a bounded time.
/// - A job whose inputs equal those of a running job waits for the result of that job.
class ClaimPolicy {
 public:
  explicit ClaimPolicy(const QueueLimits& limits) : limits_(limits) {}

  /// Adds threads that compute.
  void add_threads(int count) { threads_ += count; }

  /// Reserves a place in the queue for a job that is not in the store yet and has no id.
  Admission reserve(const QueuedJob& job, Turns::Time now);
  void release(const QueuedJob& job);  ///< frees a reserved place
  void push(const QueuedJob& job);     ///< queues the job in its reserved place
  /// Queues a job that was accepted before, whatever the limits. Returns false if the job waits or
  /// runs already.
  bool add(const QueuedJob& job);
  /// Adds a job that another process computes.
  void add_running(const QueuedJob& job);

  bool may_begin() const;
  /// Starts the next job on a free thread. Returns nullopt if no job may begin.
  std::optional<QueuedJob> begin();
  /// Starts the next job that may run on the thread of `lender`. Returns nullopt if there is none.
  std::optional<QueuedJob> begin_beside(std::int64_t lender);
  /// Returns true if a job waits that begin_beside() may start for some lender.
  bool is_urgent() const;

  /// Sets the size of the history of a running job.
  void set_result_bytes(std::int64_t id, std::int64_t bytes);
  /// Returns true if the running job is to be computed: no other one computes equal inputs (equal
  /// `key`), or the job may not wait. Otherwise the job waits until that other job ends.
  bool hold(std::int64_t id, const std::string& key, bool may_wait);

  enum class Verdict { kGoOn, kReclassed, kGiveBack };
  /// Records the processor time that a running job has used. Returns kReclassed when the job begins
  /// to count as bulk, and kGiveBack if the caller must stop the job and then requeue() it.
  Verdict use(std::int64_t id, double used_seconds);
  /// Frees the thread of the job. Its result may not be written yet.
  void computed(std::int64_t id, double used_seconds);
  /// Removes a job that waits or runs. Jobs that wait for its result return to the queue.
  void end(std::int64_t id);
  /// Moves a running job back to the queue.
  void requeue(std::int64_t id);

  bool is_waiting(std::int64_t id) const { return queue_.contains(id) || parked_.contains(id); }
  bool is_running(std::int64_t id) const { return running_.contains(id); }
  std::size_t running() const { return running_.size(); }
  Occupancy occupancy() const;
  /// Returns the sum of the estimates of the principal's jobs that wait and run [s].
  double unfinished_seconds(const std::string& principal) const;

  /// Returns the processor time after which a job counts as bulk [s]: four times its estimate, but
  /// at least 0.1 s, because the estimates of the smallest jobs are the least precise, and at most
  /// kSmallJobSeconds.
  static double allowed_seconds(const QueuedJob& job);

 private:
  /// Reserved places that no job has taken yet.
  struct Reserved {
    std::size_t jobs = 0;
    double cost_seconds = 0;
  };
  struct Running {
    QueuedJob job;
    Urgency urgency = Urgency::kBulk;  ///< kBulk once it has used its allowed time
    double charged_seconds = 0;        ///< to its principal
    double used_seconds = 0;
    double lent_seconds = 0;  ///< processor time of other jobs on its thread
    std::int64_t lender = 0;  ///< whose thread it runs on; 0: its own
    bool is_lending = false;
    bool is_computing = true;
    std::int64_t result_bytes = 0;
    std::string key;  ///< of its inputs, if jobs may wait for its result
  };

  std::optional<QueuedJob> start(QueuedJob job, std::int64_t lender);
  bool fits(const QueuedJob& job) const;
  Urgency least_urgency() const;
  void charge(Running& running, double used_seconds);
  void leave_thread(Running& running);
  void let_go(Running& running);

  const QueueLimits limits_;
  int threads_ = 0;
  FairQueue queue_;
  std::uint64_t left_ = 0;  // jobs that have left the queue for a thread
  Pace pace_;
  Turns turns_;
  Reserved reserved_;
  std::map<std::string, Reserved> reserved_of_;  // by principal
  std::map<std::int64_t, Running> running_;
  bool one_runs_alone_ = false;
  int computing_ = 0;       // jobs on threads of their own
  int computing_bulk_ = 0;  // of them, bulk jobs
  std::int64_t unwritten_bytes_ = 0;
  std::map<std::string, std::vector<QueuedJob>>
      holders_;                                 // by key: the jobs that wait for its result
  std::map<std::int64_t, std::string> parked_;  // by waiting job: the key
};

}  // namespace tribodyn::server
