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

/// How long simulations stay once they have ended. Pinned ones stay for good.
struct Retention {
  std::optional<Microseconds> keep = {};  ///< none: for good
  /// Of simulations and results that may be removed; beyond it the oldest go. 0: no budget.
  /// Revisions and pinned results do not count: no removal could make room for them.
  std::int64_t disk_budget_bytes = 0;
};

/// A thread that removes the simulations that have expired and, beyond the disk budget, those that
/// ended first, a few in a transaction so that other writers wait briefly. A simulation stays for a
/// minute after its end, so that a client that waits for it can read its result. Safe for
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
  /// One round, as the thread makes it every few seconds.
  void clean();

 private:
  void run();
  /// How many simulations went.
  int remove_expired();
  int remove_beyond_budget();
  bool is_stopping();

  Store& store_;
  const Retention retention_;
  const std::function<Microseconds()> clock_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace tribodyn::server
