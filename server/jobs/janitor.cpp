#include "server/jobs/janitor.h"

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

void Janitor::clean() {
  int removed = 0;
  const auto remove = [&](Microseconds ended_by) {
    const int now = store_.remove_oldest(ended_by, kAtATime);
    removed += now;
    return now > 0;
  };
  if (retention_.keep) {
    while (!is_stopping() && remove(clock_() - *retention_.keep)) {
    }
  }
  while (retention_.disk_budget_bytes > 0 && !is_stopping() &&
         store_.used_bytes() > retention_.disk_budget_bytes && remove(clock_() - kLeastAge)) {
  }
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
