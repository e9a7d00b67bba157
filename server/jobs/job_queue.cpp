#include "server/jobs/job_queue.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace tribodyn::server {
namespace {

constexpr auto kLookAround = std::chrono::milliseconds(20);

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

JobQueue::JobQueue(int threads, std::size_t maximum_waiting, Work work)
    : thread_count_(std::max(1, threads)),
      maximum_waiting_(maximum_waiting),
      work_(std::move(work)) {}

JobQueue::~JobQueue() { stop(); }

void JobQueue::start() {
  for (int i = 0; i < thread_count_; ++i) threads_.emplace_back([this] { run(); });
}

bool JobQueue::reserve() {
  const std::lock_guard lock(mutex_);
  if (stopping_ || waiting_.size() + reserved_ >= maximum_waiting_) return false;
  ++reserved_;
  return true;
}

void JobQueue::release() {
  const std::lock_guard lock(mutex_);
  --reserved_;
}

void JobQueue::push(std::int64_t id) {
  release();
  enqueue({id, false});
}

void JobQueue::push_resumed(std::int64_t id, bool alone) { enqueue({id, alone}); }

bool JobQueue::push_missing(std::int64_t id) {
  {
    const std::lock_guard lock(mutex_);
    if (running_.contains(id) || std::any_of(waiting_.begin(), waiting_.end(),
                                             [id](const Waiting& each) { return each.id == id; })) {
      return false;
    }
    waiting_.push_back({id, false});
  }
  changed_.notify_one();
  return true;
}

void JobQueue::enqueue(const Waiting& job) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(job);
  }
  changed_.notify_one();
}

void JobQueue::drop(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [id](const Waiting& each) { return each.id == id; });
  const auto running = running_.find(id);
  if (running != running_.end()) running->second->request(StopReason::kEnded);
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
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

/// Whether the first of the waiting may run beside those that run.
bool JobQueue::may_begin() const {
  return !waiting_.empty() && !one_runs_alone_ && (!waiting_.front().alone || running_.empty());
}

void JobQueue::run() {
  for (;;) {
    Waiting job;
    const auto signal = std::make_shared<StopSignal>();
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stopping_ || may_begin(); });
      if (stopping_) return;
      job = waiting_.front();
      waiting_.pop_front();
      running_[job.id] = signal;
      one_runs_alone_ = job.alone;
    }
    try {
      work_(job.id, *signal);
    } catch (...) {
      spdlog::critical("simulations/{}: its job threw; this is a defect", job.id);
    }
    {
      const std::lock_guard lock(mutex_);
      running_.erase(job.id);
      if (job.alone) one_runs_alone_ = false;
    }
    changed_.notify_all();
    ended_.notify_all();
  }
}

}  // namespace tribodyn::server
