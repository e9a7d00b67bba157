#include "server/jobs/job_queue.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace tribodyn::server {

JobQueue::JobQueue(int threads, std::size_t maximum_waiting, Work work)
    : maximum_waiting_(maximum_waiting), work_(std::move(work)) {
  for (int i = 0; i < std::max(1, threads); ++i) threads_.emplace_back([this] { run(); });
}

JobQueue::~JobQueue() { stop(); }

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
  enqueue(id);
}

void JobQueue::push_resumed(std::int64_t id) { enqueue(id); }

void JobQueue::enqueue(std::int64_t id) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(id);
  }
  changed_.notify_one();
}

void JobQueue::cancel(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  std::erase(waiting_, id);
  const auto running = running_.find(id);
  if (running != running_.end()) running->second->request(StopReason::kCancelled);
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

void JobQueue::run() {
  for (;;) {
    std::int64_t id = 0;
    const auto signal = std::make_shared<StopSignal>();
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
      if (stopping_) return;
      id = waiting_.front();
      waiting_.pop_front();
      running_[id] = signal;
    }
    try {
      work_(id, *signal);
    } catch (...) {
      spdlog::critical("simulations/{}: its job threw; this is a defect", id);
    }
    const std::lock_guard lock(mutex_);
    running_.erase(id);
  }
}

}  // namespace tribodyn::server
