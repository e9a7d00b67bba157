#include "server/scheduling/claim_policy.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tribodyn::server {
namespace {

constexpr double kShareOfOne = 0.75;  // share of each limit that one principal may use
constexpr double kRetryProgressShare =
    0.1;  // share of the waiting work that is done before a retry
/// Longest delay of a retry, as a multiple of the time that the waiting work takes, until the pace
/// is steady. Found by a simulated crowd six times the queue: with 3 the queue runs dry where jobs
/// become five times as fast; with 1 there are half again as many retries.
constexpr double kLongestRetryShare = 1.5;
/// The same once the pace is steady. Of 10,000 jobs at once in service_benchmark, nine times the
/// queue, 2.9 and 3.2 refusals a job in two runs without slots; 7.4 if the limit is 1.5 at any
/// pace.
constexpr double kLongestRetryShareOfSteadyPace = 6;
/// The pace is steady once so many jobs have left at about that pace, as a share of those that
/// wait. In the simulated crowd 1 gives up to a fifth more tries than 0.5, and 0.25 up to a tenth
/// fewer.
constexpr double kSteadyShare = 0.5;
/// Refused jobs come back together at the end of a time slot. Its longest length [s], also as a
/// share of the time that the waiting work takes. In service_benchmark 10,000 jobs at once take 22,
/// 21 and 28 s with slots of 0.25 s, 22, 22 and 20 s with slots of 1 s, and 31, 27 and 34 s without
/// slots: there each job needs a commit of its own, and retries always compete with computing.
constexpr double kLongestSlot = 0.25;
constexpr double kSlotShare = 0.25;
/// Processor time around a small job: its call, its commits and its answer [s]; until the pace of
/// the queue is known.
constexpr double kServiceSeconds = 2e-3;
/// Retries come somewhat faster than jobs leave the queue, so that it does not run dry.
constexpr double kRetriesPerPlace = 1.25;
/// Time used over estimate. service_benchmark finds estimates right within a factor of three.
constexpr double kOutrunFactor = 4;
constexpr double kLeastAllowedSeconds = 0.1;
/// Processor time that a job lends to interactive jobs before it has used as much itself [s].
constexpr double kInteractiveCreditSeconds = 1;

/// Returns the length of a slot [s]: a power of two, so that small changes of the waiting work do
/// not move the ends of the slots.
double slot_of(double waiting_seconds) {
  return std::min(kLongestSlot, std::exp2(std::floor(std::log2(kSlotShare * waiting_seconds))));
}

}  // namespace

double ClaimPolicy::allowed_seconds(const QueuedJob& job) {
  return std::clamp(kOutrunFactor * job.cost_seconds, kLeastAllowedSeconds, kSmallJobSeconds);
}

double ClaimPolicy::unfinished_seconds(const std::string& principal) const {
  double out = queue_.cost_seconds_of(principal);
  for (const auto& [id, running] : running_) {
    if (running.job.principal == principal) out += running.job.cost_seconds;
  }
  return out;
}

Admission ClaimPolicy::reserve(const QueuedJob& job, Turns::Time now) {
  Reserved& own = reserved_of_[job.principal];
  const double all_seconds = queue_.cost_seconds() + reserved_.cost_seconds;
  const double own_seconds = queue_.cost_seconds_of(job.principal) + own.cost_seconds;
  const std::size_t all_jobs = queue_.size() + parked_.size() + reserved_.jobs;
  const std::size_t own_jobs = queue_.size_of(job.principal) + own.jobs;
  // A principal without waiting jobs may add a job of any size while there is room.
  const bool has_room =
      all_jobs < limits_.jobs && all_seconds < limits_.cost_seconds &&
      (own_jobs == 0 ||
       (static_cast<double>(own_jobs) < kShareOfOne * static_cast<double>(limits_.jobs) &&
        own_seconds + job.cost_seconds <= kShareOfOne * limits_.cost_seconds));
  if (!has_room) {
    if (own.jobs == 0) reserved_of_.erase(job.principal);
    const int threads = std::max(1, threads_);
    const double measured = pace_.seconds_per_job(left_, now);
    const double pace = measured > 0 ? measured / kRetriesPerPlace : kServiceSeconds / threads;
    const double waiting = std::max(all_seconds / threads, static_cast<double>(all_jobs) * pace);
    const bool is_steady =
        static_cast<double>(pace_.steady_jobs()) >= kSteadyShare * static_cast<double>(all_jobs);
    const double most = is_steady ? kLongestRetryShareOfSteadyPace : kLongestRetryShare;
    const Turns::Delays delays{kRetryProgressShare * waiting, most * waiting, slot_of(waiting)};
    return {false,
            turns_.next(job.principal, delays, std::max(job.cost_seconds / threads, pace), now)};
  }
  for (Reserved* each : {&own, &reserved_}) {
    ++each->jobs;
    each->cost_seconds += job.cost_seconds;
  }
  return {true, 0};
}

void ClaimPolicy::release(const QueuedJob& job) {
  const auto own = reserved_of_.find(job.principal);
  for (Reserved* each : {&own->second, &reserved_}) {
    --each->jobs;
    each->cost_seconds = each->jobs == 0 ? 0 : each->cost_seconds - job.cost_seconds;
  }
  if (own->second.jobs == 0) reserved_of_.erase(own);
}

void ClaimPolicy::push(const QueuedJob& job) {
  release(job);
  add(job);
}

bool ClaimPolicy::add(const QueuedJob& job) {
  if (is_waiting(job.id) || is_running(job.id)) return false;
  queue_.push(job);
  return true;
}

void ClaimPolicy::add_running(const QueuedJob& job) {
  Running& running = running_[job.id];
  running.job = job;
  running.is_computing = false;  // on no thread of these
}

/// Returns the least urgency of a job that may begin: none of kBulk if all threads but one compute
/// bulk jobs.
Urgency ClaimPolicy::least_urgency() const {
  return threads_ > 1 && computing_bulk_ >= threads_ - 1 ? Urgency::kSmall : Urgency::kBulk;
}

/// Returns true if the job may run beside the running ones and its history beside theirs.
bool ClaimPolicy::fits(const QueuedJob& job) const {
  if (one_runs_alone_ || (job.alone && !running_.empty())) return false;
  return unwritten_bytes_ == 0 || unwritten_bytes_ + job.result_bytes <= limits_.unwritten_bytes;
}

bool ClaimPolicy::may_begin() const {
  const QueuedJob* next = queue_.peek(least_urgency());
  if (next == nullptr || !fits(*next)) return false;
  // Results that are written take no thread. Beyond so many of them only interactive jobs begin.
  const auto threads = static_cast<std::size_t>(std::max(1, threads_));
  return running_.size() < 2 * threads ||
         (next->urgency() == Urgency::kInteractive && running_.size() < 4 * threads);
}

std::optional<QueuedJob> ClaimPolicy::begin() {
  if (!may_begin()) return std::nullopt;
  return start(*queue_.pop(least_urgency()), 0);
}

bool ClaimPolicy::is_urgent() const {
  if (computing_ < threads_) return false;
  return queue_.peek(Urgency::kInteractive) != nullptr ||
         (computing_bulk_ >= threads_ && queue_.peek(Urgency::kSmall) != nullptr);
}

std::optional<QueuedJob> ClaimPolicy::begin_beside(std::int64_t lender) {
  const auto found = running_.find(lender);
  if (found == running_.end() || !is_urgent()) return std::nullopt;
  Running& running = found->second;
  if (!running.is_computing || running.is_lending || running.lender != 0) return std::nullopt;
  const auto may_lend = [&](Urgency least) {
    const QueuedJob* next = queue_.peek(least);
    const double credit = least == Urgency::kInteractive ? kInteractiveCreditSeconds : 0;
    return next != nullptr && running.urgency > least && fits(*next) &&
           running.lent_seconds <= running.used_seconds + credit;
  };
  for (const Urgency least : {Urgency::kInteractive, Urgency::kSmall}) {
    if (least == Urgency::kSmall && computing_bulk_ < threads_) continue;
    if (!may_lend(least)) continue;
    running.is_lending = true;
    return start(*queue_.pop(least), lender);
  }
  return std::nullopt;
}

std::optional<QueuedJob> ClaimPolicy::start(QueuedJob job, std::int64_t lender) {
  ++left_;
  Running& running = running_[job.id];
  running.job = job;
  running.urgency = job.urgency();
  running.charged_seconds = job.cost_seconds;  // by the queue
  running.lender = lender;
  running.result_bytes = job.result_bytes;
  unwritten_bytes_ += job.result_bytes;
  one_runs_alone_ = job.alone;
  if (lender == 0) {
    ++computing_;
    if (running.urgency == Urgency::kBulk) ++computing_bulk_;
  }
  return job;
}

void ClaimPolicy::set_result_bytes(std::int64_t id, std::int64_t bytes) {
  const auto found = running_.find(id);
  if (found == running_.end()) return;
  unwritten_bytes_ += bytes - found->second.result_bytes;
  found->second.result_bytes = bytes;
}

bool ClaimPolicy::hold(std::int64_t id, const std::string& key, bool may_wait) {
  const auto found = running_.find(id);
  if (found == running_.end()) return false;
  const auto [holder, is_free] = holders_.try_emplace(key);
  if (is_free) {
    found->second.key = key;
    return true;
  }
  if (!may_wait) return true;
  const QueuedJob job = found->second.job;
  charge(found->second, 0);  // refunds what the queue charged to its principal
  let_go(found->second);
  running_.erase(found);
  holder->second.push_back(job);
  parked_[id] = key;
  return false;
}

/// Charges the difference to what was charged before, which may be a refund.
void ClaimPolicy::charge(Running& running, double used_seconds) {
  queue_.charge(running.job.principal, used_seconds - running.charged_seconds);
  running.charged_seconds = used_seconds;
}

ClaimPolicy::Verdict ClaimPolicy::use(std::int64_t id, double used_seconds) {
  const auto found = running_.find(id);
  if (found == running_.end()) return Verdict::kGoOn;
  Running& running = found->second;
  running.used_seconds = used_seconds;
  if (used_seconds > running.charged_seconds) charge(running, used_seconds);
  if (running.urgency == Urgency::kBulk) {
    return running.lender == 0 ? Verdict::kGoOn : Verdict::kGiveBack;
  }
  if (used_seconds <= allowed_seconds(running.job)) return Verdict::kGoOn;
  running.urgency = Urgency::kBulk;
  running.job.requested = RequestedClass::kBulk;
  if (running.lender != 0) return Verdict::kGiveBack;
  if (running.is_computing) ++computing_bulk_;
  return Verdict::kReclassed;
}

/// Frees the thread of the job, or returns it to the lender.
void ClaimPolicy::leave_thread(Running& running) {
  if (!running.is_computing) return;
  running.is_computing = false;
  if (running.lender == 0) {
    --computing_;
    if (running.urgency == Urgency::kBulk) --computing_bulk_;
    return;
  }
  const auto lender = running_.find(running.lender);
  if (lender == running_.end()) return;
  lender->second.is_lending = false;
  lender->second.lent_seconds += running.used_seconds;
}

void ClaimPolicy::computed(std::int64_t id, double used_seconds) {
  const auto found = running_.find(id);
  if (found == running_.end()) return;
  found->second.used_seconds = used_seconds;
  charge(found->second, used_seconds);
  leave_thread(found->second);
}

/// Frees all that the job holds except its entry in running_.
void ClaimPolicy::let_go(Running& running) {
  leave_thread(running);
  unwritten_bytes_ -= running.result_bytes;
  if (running.job.alone) one_runs_alone_ = false;
  if (running.key.empty()) return;
  const auto holder = holders_.find(running.key);
  for (const QueuedJob& each : holder->second) {
    parked_.erase(each.id);
    queue_.push(each);
  }
  holders_.erase(holder);
}

void ClaimPolicy::end(std::int64_t id) {
  queue_.erase(id);
  const auto parked = parked_.find(id);
  if (parked != parked_.end()) {
    std::erase_if(holders_[parked->second], [id](const QueuedJob& job) { return job.id == id; });
    parked_.erase(parked);
  }
  const auto running = running_.find(id);
  if (running == running_.end()) return;
  let_go(running->second);
  running_.erase(running);
}

void ClaimPolicy::requeue(std::int64_t id) {
  const auto running = running_.find(id);
  if (running == running_.end()) return;
  QueuedJob job = running->second.job;
  job.alone = false;
  end(id);
  queue_.push(job);
}

Occupancy ClaimPolicy::occupancy() const {
  // Parts of campaigns have negative ids: they are the first of those that run.
  const auto slices =
      static_cast<std::size_t>(std::distance(running_.begin(), running_.lower_bound(0)));
  return {.waiting = queue_.simulations() + parked_.size(),
          .running = running_.size() - slices,
          .waiting_seconds = queue_.simulation_seconds(),
          .parts = queue_.size() - queue_.simulations() + slices};
}

}  // namespace tribodyn::server
