#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <vector>

#include "server/storage/connection.h"

namespace tribodyn::server {

/// Lets writers share a transaction: those who come while a commit is on its way to disk wait for
/// it and then go together, so that many of them cost little more than one. Each is undone alone
/// when it throws, and all return when theirs is on disk. Safe for concurrent access.
class GroupCommit {
 public:
  /// Changes rows, and nothing else: it runs again, alone, when a group fails as a whole.
  using Action = std::function<void(Connection&)>;

  /// `writer` is used under `writer_mutex` only; both must outlive the object.
  GroupCommit(Connection& writer, std::mutex& writer_mutex)
      : writer_(writer), writer_mutex_(writer_mutex) {}

  /// Throws what the action throws, or SQLite::Exception where it cannot be committed; nothing has
  /// changed then: with SQLITE_INTERRUPT if `limits` were over before the action began or, where it
  /// goes alone, before it ended.
  void run(const Action& action, const CallLimits& limits);

 private:
  struct Pending {
    const Action* action = nullptr;
    const CallLimits* limits = nullptr;
    std::exception_ptr error = nullptr;
    bool is_done = false;
    std::condition_variable changed = {};  // done, or its turn to commit for the others
  };
  using Group = std::vector<Pending*>;

  void commit(const Group& group, bool is_own);
  bool commit_together(const Group& group);
  void commit_alone(Pending& pending, const CallLimits& limits);

  Connection& writer_;
  std::mutex& writer_mutex_;
  std::mutex mutex_;
  std::deque<Pending*> pending_;  // guarded by mutex_
  bool is_led_ = false;           // guarded by mutex_; somebody commits for the others
};

}  // namespace tribodyn::server
