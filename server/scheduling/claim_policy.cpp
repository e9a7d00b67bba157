#include "server/scheduling/claim_policy.h"

#include <algorithm>

namespace tribodyn::server {
namespace {

constexpr double kShareOfOne = 0.75;      // of the limits, for one principal
constexpr double kWorthAsking = 0.1;      // of what waits is done by then
constexpr double kServiceSeconds = 2e-3;  // of a processor, for what is done around a small job
constexpr double kOutrunFactor = 4;       // estimates are right within a factor of three
constexpr double kLeastAllowedSeconds = 0.1;
constexpr double kStatedCreditSeconds = 1;  // that a job lends before it has used as much itself

}  // namespace

double ClaimPolicy::allowed_seconds(const QueuedJob& job) {
  return std::clamp(kOutrunFactor * job.cost_seconds, kLeastAllowedSeconds, kInteractiveSeconds);
}

Admission ClaimPolicy::reserve(const QueuedJob& job, Turns::Time now) {
  Reserved& own = reserved_of_[job.principal];
  const double all_seconds = queue_.cost_seconds() + reserved_.cost_seconds;
  const double own_seconds = queue_.cost_seconds_of(job.principal) + own.cost_seconds;
  const std::size_t all_jobs = queue_.size() + parked_.size() + reserved_.jobs;
  const std::size_t own_jobs = queue_.size_of(job.principal) + own.jobs;
  // Whoever has nothing waiting gets in however large the job is, as long as there is room at all.
  const bool has_room =
      all_jobs < limits_.jobs && all_seconds < limits_.cost_seconds &&
      (own_jobs == 0 ||
       (static_cast<double>(own_jobs) < kShareOfOne * static_cast<double>(limits_.jobs) &&
        own_seconds + job.cost_seconds <= kShareOfOne * limits_.cost_seconds));
  if (!has_room) {
    if (own.jobs == 0) reserved_of_.erase(job.principal);
    const int threads = std::max(1, threads_);
    return {false, turns_.next(job.principal, kWorthAsking * all_seconds / threads,
                               std::max(job.cost_seconds, kServiceSeconds) / threads, now)};
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

/// The last lane that may begin: where all threads but one compute bulk jobs, these wait.
Lane ClaimPolicy::last_lane() const {
  return threads_ > 1 && computing_bulk_ >= threads_ - 1 ? Lane::kSmall : Lane::kBulk;
}

/// Whether the job may run beside those that run. Unwritten results do not heap up.
bool ClaimPolicy::fits(const QueuedJob& job) const {
  if (one_runs_alone_ || (job.alone && !running_.empty())) return false;
  return unwritten_bytes_ == 0 || unwritten_bytes_ + job.result_bytes <= limits_.unwritten_bytes;
}

bool ClaimPolicy::may_begin() const {
  if (running_.size() >= 2 * static_cast<std::size_t>(std::max(1, threads_))) return false;
  const QueuedJob* next = queue_.peek(last_lane());
  return next != nullptr && fits(*next);
}

std::optional<QueuedJob> ClaimPolicy::begin() {
  if (!may_begin()) return std::nullopt;
  return start(*queue_.pop(last_lane()), 0);
}

bool ClaimPolicy::is_urgent() const {
  if (computing_ < threads_) return false;
  return queue_.peek(Lane::kStated) != nullptr ||
         (computing_bulk_ >= threads_ && queue_.peek(Lane::kSmall) != nullptr);
}

std::optional<QueuedJob> ClaimPolicy::begin_beside(std::int64_t lender) {
  const auto found = running_.find(lender);
  if (found == running_.end() || !is_urgent()) return std::nullopt;
  Running& running = found->second;
  if (!running.is_computing || running.is_lending || running.lender != 0) return std::nullopt;
  const auto may_lend = [&](Lane last) {
    const QueuedJob* next = queue_.peek(last);
    const double credit = last == Lane::kStated ? kStatedCreditSeconds : 0;
    return next != nullptr && running.lane > last && fits(*next) &&
           running.lent_seconds <= running.used_seconds + credit;
  };
  for (const Lane last : {Lane::kStated, Lane::kSmall}) {
    if (last == Lane::kSmall && computing_bulk_ < threads_) continue;
    if (!may_lend(last)) continue;
    running.is_lending = true;
    return start(*queue_.pop(last), lender);
  }
  return std::nullopt;
}

std::optional<QueuedJob> ClaimPolicy::start(QueuedJob job, std::int64_t lender) {
  Running& running = running_[job.id];
  running.job = job;
  running.lane = job.lane();
  running.charged_seconds = job.cost_seconds;  // by the queue
  running.lender = lender;
  running.result_bytes = job.result_bytes;
  unwritten_bytes_ += job.result_bytes;
  one_runs_alone_ = job.alone;
  if (lender == 0) {
    ++computing_;
    if (running.lane == Lane::kBulk) ++computing_bulk_;
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
  charge(found->second, 0);  // its principal gets back what the queue charged
  let_go(found->second);
  running_.erase(found);
  holder->second.push_back(job);
  parked_[id] = key;
  return false;
}

/// Charges what was used beyond what was charged; less than that is given back at the end only.
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
  if (running.lane == Lane::kBulk) {
    return running.lender == 0 ? Verdict::kGoOn : Verdict::kGiveBack;
  }
  if (used_seconds <= allowed_seconds(running.job)) return Verdict::kGoOn;
  running.lane = Lane::kBulk;
  running.job.stated = StatedClass::kBulk;
  if (running.lender != 0) return Verdict::kGiveBack;
  if (running.is_computing) ++computing_bulk_;
  return Verdict::kReclassed;
}

/// Takes the job off its thread, or off the one that was lent to it.
void ClaimPolicy::leave_thread(Running& running) {
  if (!running.is_computing) return;
  running.is_computing = false;
  if (running.lender == 0) {
    --computing_;
    if (running.lane == Lane::kBulk) --computing_bulk_;
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

/// Everything that the job takes beside its entry in running_.
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

void ClaimPolicy::requeue(std::int64_t id, bool alone) {
  const auto running = running_.find(id);
  if (running == running_.end()) return;
  QueuedJob job = running->second.job;
  job.alone = alone;
  end(id);
  queue_.push(job);
}

Occupancy ClaimPolicy::occupancy() const {
  return {queue_.size() + parked_.size(), running_.size(), queue_.cost_seconds()};
}

}  // namespace tribodyn::server
