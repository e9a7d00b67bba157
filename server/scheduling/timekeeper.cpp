#include "server/scheduling/timekeeper.h"

#include <algorithm>

namespace tribodyn::server {

using std::chrono::steady_clock;

Timekeeper::Timekeeper(std::chrono::milliseconds tick, std::function<Microseconds()> clock,
                       std::function<void(std::int64_t)> on_due, std::function<void()> on_tick)
    : tick_(tick),
      clock_(std::move(clock)),
      on_due_(std::move(on_due)),
      on_tick_(std::move(on_tick)) {
  thread_ = std::thread([this] { run(); });
}

Timekeeper::~Timekeeper() { stop(); }

void Timekeeper::set_deadline(std::int64_t id, Microseconds time) {
  {
    const std::lock_guard lock(mutex_);
    const auto [known, is_new] = times_.try_emplace(id, time);
    if (!is_new) deadlines_.erase({known->second, id});
    known->second = time;
    deadlines_.emplace(time, id);
  }
  changed_.notify_all();
}

void Timekeeper::remove_deadline(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  const auto known = times_.find(id);
  if (known == times_.end()) return;
  deadlines_.erase({known->second, id});
  times_.erase(known);
}

std::size_t Timekeeper::deadlines() const {
  const std::lock_guard lock(mutex_);
  return deadlines_.size();
}

void Timekeeper::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::vector<std::int64_t> Timekeeper::take_due() {
  std::vector<std::int64_t> due;
  const Microseconds now = clock_();
  while (!deadlines_.empty() && deadlines_.begin()->first <= now) {
    due.push_back(deadlines_.begin()->second);
    times_.erase(due.back());
    deadlines_.erase(deadlines_.begin());
  }
  return due;
}

void Timekeeper::run() {
  auto next_tick = steady_clock::now() + tick_;
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    std::chrono::microseconds wait = std::chrono::duration_cast<std::chrono::microseconds>(
        std::max(next_tick - steady_clock::now(), steady_clock::duration::zero()));
    if (!deadlines_.empty()) {
      const Microseconds left = std::max<Microseconds>(0, deadlines_.begin()->first - clock_());
      wait = std::min(wait, std::chrono::microseconds(left));
    }
    changed_.wait_for(lock, wait);
    const std::vector<std::int64_t> due = take_due();
    const bool is_tick = steady_clock::now() >= next_tick;
    if (is_tick) next_tick = steady_clock::now() + tick_;
    lock.unlock();
    for (const std::int64_t id : due) on_due_(id);
    if (is_tick) {
      observers_.tell();
      on_tick_();
    }
    lock.lock();
  }
}

}  // namespace tribodyn::server
