#include "server/scheduling/timekeeper.h"

#include <algorithm>

namespace tribodyn::server {

using std::chrono::steady_clock;

Timekeeper::Timekeeper(std::chrono::milliseconds tick, std::function<Microseconds()> clock,
                       std::function<void(std::int64_t)> on_due)
    : tick_(tick), clock_(std::move(clock)), on_due_(std::move(on_due)) {
  thread_ = std::thread([this] { run(); });
}

Timekeeper::~Timekeeper() { stop(); }

void Timekeeper::add_deadline(std::int64_t id, Microseconds time) {
  {
    const std::lock_guard lock(mutex_);
    deadlines_.emplace(time, id);
  }
  changed_.notify_all();
}

void Timekeeper::observe(const std::weak_ptr<ProgressObserver>& observer) {
  const std::lock_guard lock(mutex_);
  std::erase_if(observers_, [](const auto& weak) { return weak.expired(); });
  observers_.push_back(observer);
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
    deadlines_.erase(deadlines_.begin());
  }
  return due;
}

std::vector<std::shared_ptr<ProgressObserver>> Timekeeper::living_observers() {
  std::vector<std::shared_ptr<ProgressObserver>> out;
  for (const auto& weak : observers_) {
    if (auto observer = weak.lock()) out.push_back(std::move(observer));
  }
  return out;
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
    std::vector<std::shared_ptr<ProgressObserver>> woken;
    if (steady_clock::now() >= next_tick) {
      next_tick = steady_clock::now() + tick_;
      woken = living_observers();
    }
    lock.unlock();
    for (const std::int64_t id : due) on_due_(id);
    for (const auto& observer : woken) observer->changed();
    woken.clear();
    lock.lock();
  }
}

}  // namespace tribodyn::server
