#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "server/storage/times.h"
#include "server/support/observers.h"

namespace tribodyn::server {

/// A thread that reports deadlines when they pass and, every `tick`, notifies observers, so that a
/// stream can send a heartbeat. Safe for concurrent access without external synchronization.
class Timekeeper {
 public:
  /// Starts the thread, which calls `on_due` with the id of each deadline that has passed, and
  /// `on_tick` every `tick`, with no lock held.
  Timekeeper(std::chrono::milliseconds tick, std::function<Microseconds()> clock,
             std::function<void(std::int64_t)> on_due, std::function<void()> on_tick);
  ~Timekeeper();
  Timekeeper(const Timekeeper&) = delete;
  Timekeeper& operator=(const Timekeeper&) = delete;

  /// Sets the deadline of the id, in place of its former one.
  void set_deadline(std::int64_t id, Microseconds time);
  void remove_deadline(std::int64_t id);
  std::size_t deadlines() const;
  /// Notifies the observer every tick until it is destroyed.
  void observe(const std::weak_ptr<Observer>& observer) { observers_.add(observer); }
  /// Ends the thread. No further call is made.
  void stop();

 private:
  void run();
  std::vector<std::int64_t> take_due();

  const std::chrono::milliseconds tick_;
  const std::function<Microseconds()> clock_;
  const std::function<void(std::int64_t)> on_due_;
  const std::function<void()> on_tick_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::set<std::pair<Microseconds, std::int64_t>> deadlines_;  // guarded by mutex_
  std::map<std::int64_t, Microseconds> times_;  // guarded by mutex_; deadlines_ by id
  bool stopping_ = false;                       // guarded by mutex_
  Observers observers_;
  std::thread thread_;
};

}  // namespace tribodyn::server
