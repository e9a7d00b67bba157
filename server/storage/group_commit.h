#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <vector>

#include "server/storage/connection.h"

namespace tribodyn::server {

/// Combines the transactions of several writers: those that arrive during a commit wait for it and
/// are then committed together, at little more than the cost of one. If an action throws, only that
/// action is rolled back. run() returns when the action is on disk. Safe for concurrent access.
class GroupCommit {
 public:
  /// Must only change rows: if a group fails as a whole, each action runs again alone.
  using Action = std::function<void(Connection&)>;

  /// Both arguments must outlive the object. `writer` is used with `writer_mutex` locked.
  GroupCommit(Connection& writer, std::mutex& writer_mutex)
      : writer_(writer), writer_mutex_(writer_mutex) {}

  /// Runs and commits an action. Throws what the action throws, or SQLite::Exception if it cannot
  /// be committed; then nothing has changed. Throws SQLITE_INTERRUPT if `limits` were over before
  /// the action began, or before its end if it is committed alone.
  void run(const Action& action, const CallLimits& limits);

 private:
  struct Pending {
    const Action* action = nullptr;
    const CallLimits* limits = nullptr;
    std::exception_ptr error = nullptr;
    bool is_done = false;
    // signalled when done, and when this thread must commit the next group
    std::condition_variable changed = {};
  };
  using Group = std::vector<Pending*>;

  void commit(const Group& group, bool is_own);
  bool commit_together(const Group& group);
  void commit_alone(Pending& pending, const CallLimits& limits);

  Connection& writer_;
  std::mutex& writer_mutex_;
  std::mutex mutex_;
  std::deque<Pending*> pending_;  // guarded by mutex_
  bool is_led_ = false;           // guarded by mutex_; true while a thread commits a group
};

}  // namespace tribodyn::server
