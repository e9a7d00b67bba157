#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "server/storage/store.h"

namespace tribodyn::server {

/// How long ended simulations are kept. Pinned ones are kept until they are unpinned.
struct Retention {
  std::optional<Microseconds> keep = {};  ///< empty: for ever
  /// Largest size of the simulations and results that may be removed; beyond it the janitor removes
  /// the oldest. 0: no limit. Revisions and pinned results do not count, because the janitor cannot
  /// remove them.
  std::int64_t disk_budget_bytes = 0;
};

/// Says whether the wall clock may be believed when something is to be removed for its age: not for
/// an hour after it jumped against the time since the machine started, and not for an hour after
/// the first look if the clock is more than a day ahead of `known`, the latest time that was
/// written. Not safe for concurrent access.
class ClockTrust {
 public:
  /// Takes note of both clocks; to be called every few seconds. `running`: time since the machine
  /// started, sleep included.
  bool look(Microseconds wall, Microseconds running, std::optional<Microseconds> known);

  static constexpr Microseconds kHold = 3'600'000'000;
  static constexpr Microseconds kLargestStep = 10'000'000;  ///< beyond it a change is a jump

 private:
  std::optional<Microseconds> offset_;   // of the wall clock at the last look
  std::optional<Microseconds> held_to_;  // on the clock `running`
};

/// A thread that removes expired simulations and, beyond the disk budget, those that ended first;
/// nothing while the clock is not to be believed (ClockTrust).
/// It removes a few in each transaction, so that other writers wait briefly. It keeps each
/// simulation for a minute after its end, so that a client that waits can read the result. Safe for
/// concurrent access; `start` and `stop` from one thread.
class Janitor {
 public:
  /// The store must outlive the object.
  Janitor(Store& store, const Retention& retention, std::function<Microseconds()> clock);
  ~Janitor();
  Janitor(const Janitor&) = delete;
  Janitor& operator=(const Janitor&) = delete;

  void start();
  void stop();
  /// Removes what should be removed now. The thread calls it every few seconds.
  void clean();

 private:
  void run();
  bool trusts_clock();
  // These functions return the number of simulations that they removed.
  int remove_expired();
  int remove_beyond_budget();
  bool is_stopping();

  Store& store_;
  const Retention retention_;
  const std::function<Microseconds()> clock_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;  // guarded by mutex_
  ClockTrust trust_;       // of the thread, as below
  bool trusted_clock_ = true;
  std::thread thread_;
};

}  // namespace tribodyn::server
