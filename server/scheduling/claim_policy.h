#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/metrics/metrics.h"
#include "server/scheduling/fair_queue.h"
#include "server/scheduling/turns.h"

namespace tribodyn::server {

/// What may wait; of each at most three quarters for one principal, so that others still get in.
struct QueueLimits {
  std::size_t jobs = 20'000;
  double cost_seconds = 360'000;  ///< estimated, of one processor
  /// Of histories that are computed or not yet written; one job begins however large it is.
  std::int64_t unwritten_bytes = 512'000'000;
};

/// Whether a job has a place, and when it is worth asking again if not (Turns).
struct Admission {
  bool is_admitted = false;
  double retry_seconds = 0;
};

/// Decides which job begins next, and knows those that wait and run. It reads no clock, starts no
/// thread and knows no store; times come from the caller. Not safe for concurrent access.
///
/// Order: FairQueue. Where several threads compute, one is kept for interactive jobs. A job that
/// uses more than its estimate allows (allowed_seconds) is bulk from then on, and its principal
/// pays for the time used. A job that is not stated INTERACTIVE lends its thread to those that are,
/// and a bulk job, if all threads compute bulk jobs, also to small ones: begin_beside. What runs on
/// a lent thread and outruns its estimate goes back to the queue as a bulk job, so that the lender
/// waits for a bounded time. A job whose result equal inputs are about to give waits for it.
class ClaimPolicy {
 public:
  explicit ClaimPolicy(const QueueLimits& limits) : limits_(limits) {}

  /// So many more threads compute.
  void add_threads(int count) { threads_ += count; }

  /// A place among the waiting, before the job is written down anywhere and has an id.
  Admission reserve(const QueuedJob& job, Turns::Time now);
  void release(const QueuedJob& job);  ///< gives a reserved place back
  void push(const QueuedJob& job);     ///< takes the reserved place
  /// Beyond the limits: a job that was accepted before. Returns false if it is here already.
  bool add(const QueuedJob& job);
  /// A job that another process computes.
  void add_running(const QueuedJob& job);

  bool may_begin() const;
  /// Takes the next job for a free thread; nullopt if none may begin.
  std::optional<QueuedJob> begin();
  /// Takes the next job that may run on the thread of `lender`, which goes on afterwards.
  std::optional<QueuedJob> begin_beside(std::int64_t lender);
  /// Whether begin_beside might give a job to some lender.
  bool is_urgent() const;

  /// Bytes of the history that a running job will have.
  void set_result_bytes(std::int64_t id, std::int64_t bytes);
  /// True if nobody computes equal inputs, or the job may not wait: it goes on. Else it waits until
  /// that other job ends.
  bool hold(std::int64_t id, const std::string& key, bool may_wait);

  enum class Verdict { kGoOn, kReclassed, kGiveBack };
  /// A running job has used so much of a processor up to now. kReclassed, told once: it is a bulk
  /// job from now on. kGiveBack: it is to stop, and to come back by requeue().
  Verdict use(std::int64_t id, double used_seconds);
  /// The job leaves its thread; its result may not be written yet.
  void computed(std::int64_t id, double used_seconds);
  /// Nothing is left to be done for the job, wherever it is. Jobs with equal inputs wait no more.
  void end(std::int64_t id);
  /// A running job waits again.
  void requeue(std::int64_t id, bool alone);

  bool is_waiting(std::int64_t id) const { return queue_.contains(id) || parked_.contains(id); }
  bool is_running(std::int64_t id) const { return running_.contains(id); }
  std::size_t running() const { return running_.size(); }
  Occupancy occupancy() const;

  /// Of a processor, until a job that is not stated BULK counts as bulk [s]: four times the
  /// estimate, but at least 0.1 s (the estimates of small jobs are less precise than that of their
  /// sum) and at most kInteractiveSeconds.
  static double allowed_seconds(const QueuedJob& job);

 private:
  /// Places given out that no job has taken yet.
  struct Reserved {
    std::size_t jobs = 0;
    double cost_seconds = 0;
  };
  struct Running {
    QueuedJob job;
    Lane lane = Lane::kBulk;     ///< as it counts now
    double charged_seconds = 0;  ///< to its principal
    double used_seconds = 0;
    double lent_seconds = 0;  ///< used by others on its thread
    std::int64_t lender = 0;  ///< 0: it has a thread of its own
    bool is_lending = false;
    bool is_computing = true;
    std::int64_t result_bytes = 0;
    std::string key;  ///< that it holds; empty: none
  };

  std::optional<QueuedJob> start(QueuedJob job, std::int64_t lender);
  bool fits(const QueuedJob& job) const;
  Lane last_lane() const;
  void charge(Running& running, double used_seconds);
  void leave_thread(Running& running);
  void let_go(Running& running);

  const QueueLimits limits_;
  int threads_ = 0;
  FairQueue queue_;
  Turns turns_;
  Reserved reserved_;
  std::map<std::string, Reserved> reserved_of_;  // by principal
  std::map<std::int64_t, Running> running_;
  bool one_runs_alone_ = false;
  int computing_ = 0;       // on threads of their own
  int computing_bulk_ = 0;  // of these
  std::int64_t unwritten_bytes_ = 0;
  std::map<std::string, std::vector<QueuedJob>> holders_;  // by key: who waits for its holder
  std::map<std::int64_t, std::string> parked_;             // by job: the key that it waits for
};

}  // namespace tribodyn::server
