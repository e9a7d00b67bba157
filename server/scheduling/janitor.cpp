#include "server/scheduling/janitor.h"

#include <spdlog/spdlog.h>

#include <cstdlib>
#include <fstream>
#include <utility>

namespace tribodyn::server {
namespace {

constexpr auto kBetweenRounds = std::chrono::seconds(5);
constexpr Microseconds kLeastAge = 60'000'000;
constexpr int kAtATime = 50;

}  // namespace

bool ClockTrust::look(Microseconds wall, Microseconds running, std::optional<Microseconds> known) {
  constexpr Microseconds kDay = 86'400'000'000;
  const Microseconds offset = wall - running;
  const bool has_jumped =
      offset_ ? std::abs(offset - *offset_) > kLargestStep : known && wall > *known + kDay;
  offset_ = offset;
  if (has_jumped) held_to_ = running + kHold;
  if (held_to_ && running >= *held_to_) held_to_.reset();
  return !held_to_;
}

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

bool Janitor::trusts_clock() {
  double seconds = 0;
  std::ifstream("/proc/uptime") >> seconds;  // not a clock that the process may have faked or set
  const bool out =
      trust_.look(clock_(), static_cast<Microseconds>(1e6 * seconds), store_.latest_creation());
  if (out != std::exchange(trusted_clock_, out)) {
    spdlog::warn(out ? "event=clock_trusted" : "event=clock_jumped nothing_removed_for_minutes=60");
  }
  return out;
}

void Janitor::run() {
  while (!is_stopping()) {
    try {
      if (trusts_clock()) clean();
    } catch (const StoreError& error) {
      spdlog::error("{}", error.what());
    }
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kBetweenRounds, [this] { return stopping_; });
  }
}

}  // namespace tribodyn::server
