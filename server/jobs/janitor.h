#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "server/store/store.h"

namespace tribodyn::server {

/// How long simulations stay once they have ended. Pinned ones stay for good.
struct Retention {
  std::optional<Microseconds> keep = {};  ///< none: for good
  std::int64_t disk_budget_bytes = 0;     ///< of the database; beyond it the oldest go. 0: none
};

/// A thread that removes what has expired and, beyond the disk budget, what ended first, a few at a
/// time so that nobody waits long. What has just ended stays for a minute, so that whoever waits
/// for it can read it. Safe for concurrent access; `start` and `stop` from one thread.
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
