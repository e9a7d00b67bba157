#include "server/scheduling/janitor.h"

#include <spdlog/spdlog.h>

namespace tribodyn::server {
namespace {

constexpr auto kBetweenRounds = std::chrono::seconds(5);
constexpr Microseconds kLeastAge = 60'000'000;
constexpr int kAtATime = 50;

}  // namespace

Janitor::Janitor(Store& store, const Retention& retention, std::function<Microseconds()> clock)
    : store_(store), retention_(retention), clock_(std::move(clock)) {}

Janitor::~Janitor() { stop(); }

void Janitor::start() {
  if (!retention_.keep && retention_.disk_budget_bytes == 0) return;
  thread_ = std::thread([this] { run(); });
}

void Janitor::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool Janitor::is_stopping() {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

int Janitor::remove_expired() {
  int count = 0;
  while (retention_.keep && !is_stopping()) {
    const Removed removed = store_.remove_oldest(clock_() - *retention_.keep, kAtATime);
    if (removed.count() == 0) break;
    count += removed.count();
  }
  return count;
}

int Janitor::remove_beyond_budget() {
  const std::int64_t budget = retention_.disk_budget_bytes;
  // The size of the database is an upper bound that is quick to find.
  if (budget == 0 || store_.used_bytes() <= budget) return 0;
  int count = 0;
  std::int64_t left = store_.removable_bytes();
  while (left > budget && !is_stopping()) {
    const Removed removed = store_.remove_oldest(clock_() - kLeastAge, kAtATime);
    if (removed.count() == 0) break;
    count += removed.count();
    left -= removed.bytes;
  }
  return count;
}

void Janitor::clean() {
  const int removed = remove_expired() + remove_beyond_budget();
  if (removed > 0) spdlog::info("event=simulations_removed count={}", removed);
}

void Janitor::run() {
  while (!is_stopping()) {
    try {
      clean();
    } catch (const StoreError& error) {
      spdlog::error("{}", error.what());
    }
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kBetweenRounds, [this] { return stopping_; });
  }
}

}  // namespace tribodyn::server
