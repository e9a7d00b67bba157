#include "server/scheduling/job_queue.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace tribodyn::server {
namespace {

constexpr auto kLookAround = std::chrono::milliseconds(20);
constexpr double kShareOfOne = 0.75;      // of the limits, for one principal
constexpr double kWorthAsking = 0.1;      // of what waits is done by then
constexpr double kServiceSeconds = 2e-3;  // of a processor, for what is done around a small job

/// Does it, whatever it throws.
void shielded(std::int64_t id, const std::function<void()>& action) {
  try {
    action();
  } catch (...) {
    spdlog::critical("simulations/{}: its job threw; this is a defect", id);
  }
}

}  // namespace

void StopSignal::request(StopReason reason) {
  StopReason none = StopReason::kNone;
  {
    const std::lock_guard lock(mutex_);
    reason_.compare_exchange_strong(none, reason);
  }
  requested_.notify_all();
}

bool StopSignal::wait_for(std::chrono::milliseconds time) const {
  std::unique_lock lock(mutex_);
  return !requested_.wait_for(lock, time, [this] { return requested(); });
}

JobQueue::JobQueue(int threads, const QueueLimits& limits, Work work)
    : thread_count_(std::max(1, threads)), limits_(limits), work_(std::move(work)) {}

JobQueue::~JobQueue() { stop(); }

void JobQueue::start() {
  for (int i = 0; i < thread_count_; ++i) {
    threads_.emplace_back([this] { compute(); });
    writers_.emplace_back([this] { write_down(); });
  }
}

Admission JobQueue::reserve(const QueuedJob& job) {
  const std::lock_guard lock(mutex_);
  Reserved& own = reserved_of_[job.principal];
  const double all_seconds = waiting_.cost_seconds() + reserved_.cost_seconds;
  const double own_seconds = waiting_.cost_seconds_of(job.principal) + own.cost_seconds;
  const std::size_t all_jobs = waiting_.size() + reserved_.jobs;
  const std::size_t own_jobs = waiting_.size_of(job.principal) + own.jobs;
  // Whoever has nothing waiting gets in however large the job is, as long as there is room at all.
  const bool has_room =
      all_jobs < limits_.jobs && all_seconds < limits_.cost_seconds &&
      (own_jobs == 0 ||
       (static_cast<double>(own_jobs) < kShareOfOne * static_cast<double>(limits_.jobs) &&
        own_seconds + job.cost_seconds <= kShareOfOne * limits_.cost_seconds));
  if (stopping_ || !has_room) {
    if (own.jobs == 0) reserved_of_.erase(job.principal);
    return {false, turns_.next(job.principal, kWorthAsking * all_seconds / thread_count_,
                               std::max(job.cost_seconds, kServiceSeconds) / thread_count_,
                               std::chrono::steady_clock::now())};
  }
  for (Reserved* each : {&own, &reserved_}) {
    ++each->jobs;
    each->cost_seconds += job.cost_seconds;
  }
  return {true, 0};
}

void JobQueue::give_back(const QueuedJob& job) {
  const auto own = reserved_of_.find(job.principal);
  for (Reserved* each : {&own->second, &reserved_}) {
    --each->jobs;
    each->cost_seconds = each->jobs == 0 ? 0 : each->cost_seconds - job.cost_seconds;
  }
  if (own->second.jobs == 0) reserved_of_.erase(own);
}

void JobQueue::release(const QueuedJob& job) {
  const std::lock_guard lock(mutex_);
  give_back(job);
}

void JobQueue::push(const QueuedJob& job) {
  {
    const std::lock_guard lock(mutex_);
    give_back(job);
    waiting_.push(job);
  }
  changed_.notify_one();
}

void JobQueue::push_resumed(const QueuedJob& job) { enqueue(job); }

bool JobQueue::push_missing(const QueuedJob& job) {
  {
    const std::lock_guard lock(mutex_);
    if (running_.contains(job.id) || waiting_.contains(job.id)) return false;
    waiting_.push(job);
  }
  changed_.notify_one();
  return true;
}

void JobQueue::enqueue(const QueuedJob& job) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push(job);
  }
  changed_.notify_one();
}

void JobQueue::drop(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  waiting_.erase(id);
  const auto running = running_.find(id);
  if (running != running_.end()) running->second->request(StopReason::kEnded);
}

Occupancy JobQueue::occupancy() const {
  const std::lock_guard lock(mutex_);
  return {waiting_.size(), running_.size(), waiting_.cost_seconds()};
}

bool JobQueue::is_stopping() const {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

bool JobQueue::drain(std::chrono::milliseconds limit, const std::function<bool()>& give_up) {
  const auto end = std::chrono::steady_clock::now() + limit;
  std::unique_lock lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
  while (!running_.empty() && std::chrono::steady_clock::now() < end && !give_up()) {
    ended_.wait_for(lock, kLookAround);
  }
  return running_.empty();
}

void JobQueue::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    for (const auto& [id, signal] : running_) signal->request(StopReason::kShutdown);
  }
  changed_.notify_all();
  join();
}

/// What was computed is written down before the end.
void JobQueue::join() {
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  {
    const std::lock_guard lock(mutex_);
    all_computed_ = true;
  }
  computed_.notify_all();
  for (std::thread& writer : writers_) writer.join();
  writers_.clear();
}

/// The last lane that may begin: where all threads but one compute bulk jobs, these wait.
Lane JobQueue::last_lane() const {
  return thread_count_ > 1 && computing_bulk_ >= thread_count_ - 1 ? Lane::kSmall : Lane::kBulk;
}

/// Whether the next of the waiting may run beside those that run. Unwritten results do not heap up.
bool JobQueue::may_begin() const {
  const std::size_t most = 2 * static_cast<std::size_t>(thread_count_);
  if (one_runs_alone_ || running_.size() >= most) return false;
  const QueuedJob* next = waiting_.peek(last_lane());
  return next != nullptr && (!next->alone || running_.empty());
}

/// Nothing when the queue stops.
std::optional<JobQueue::Running> JobQueue::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopping_ || may_begin(); });
  if (stopping_) return std::nullopt;
  Running out{*waiting_.pop(last_lane()), std::make_shared<StopSignal>(), {}};
  running_[out.job.id] = out.signal;
  one_runs_alone_ = out.job.alone;
  if (!out.job.is_interactive()) ++computing_bulk_;
  return out;
}

/// What it leaves to be done goes to the writers.
void JobQueue::finish_computing(Running computed) {
  const QueuedJob job = computed.job;
  const bool has_rest = static_cast<bool>(computed.rest);
  {
    const std::lock_guard lock(mutex_);
    if (!job.is_interactive()) --computing_bulk_;
    if (has_rest) unwritten_.push_back(std::move(computed));
  }
  if (!has_rest) return end(job);
  computed_.notify_one();
}

void JobQueue::end(const QueuedJob& job) {
  {
    const std::lock_guard lock(mutex_);
    running_.erase(job.id);
    if (job.alone) one_runs_alone_ = false;
  }
  changed_.notify_all();
  ended_.notify_all();
}

void JobQueue::compute() {
  while (std::optional<Running> running = next()) {
    shielded(running->job.id, [&] { work_(running->job.id, *running->signal, running->rest); });
    finish_computing(*std::move(running));
  }
}

/// Nothing when there will be none.
std::optional<JobQueue::Running> JobQueue::next_unwritten() {
  std::unique_lock lock(mutex_);
  computed_.wait(lock, [this] { return all_computed_ || !unwritten_.empty(); });
  if (unwritten_.empty()) return std::nullopt;
  Running out = std::move(unwritten_.front());
  unwritten_.pop_front();
  return out;
}

void JobQueue::write_down() {
  while (std::optional<Running> running = next_unwritten()) {
    shielded(running->job.id, running->rest);
    running->rest = nullptr;
    end(running->job);
  }
}

}  // namespace tribodyn::server
