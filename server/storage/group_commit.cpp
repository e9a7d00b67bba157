#include "server/storage/group_commit.h"

#include <sqlite3.h>

#include <algorithm>

namespace tribodyn::server {
namespace {

constexpr std::size_t kLargestGroup = 64;

bool is_in_transaction(Connection& db) { return sqlite3_get_autocommit(db.getHandle()) == 0; }

void roll_back(Connection& db) {
  if (is_in_transaction(db)) db.tryExec("ROLLBACK");
}

void require_caller(const CallLimits& limits) {
  if (limits.are_over()) throw SQLite::Exception("nobody waits any more", SQLITE_INTERRUPT);
}

}  // namespace

void GroupCommit::run(const Action& action, const CallLimits& limits) {
  Pending own{&action, &limits};
  std::unique_lock lock(mutex_);
  pending_.push_back(&own);
  while (!own.is_done) {
    if (is_led_) {
      own.changed.wait(lock);
      continue;
    }
    is_led_ = true;
    const std::size_t count = std::min(pending_.size(), kLargestGroup);
    const Group group(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count));
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count));
    lock.unlock();
    commit(group, count == 1 && group.front() == &own);
    lock.lock();
    for (Pending* each : group) {
      each->is_done = true;
      each->changed.notify_one();
    }
    is_led_ = false;
    if (!pending_.empty()) pending_.front()->changed.notify_one();
  }
  lock.unlock();
  if (own.error) std::rethrow_exception(own.error);
}

void GroupCommit::commit(const Group& group, bool is_own) {
  const std::lock_guard lock(writer_mutex_);
  if (is_own) return commit_alone(*group.front(), *group.front()->limits);
  if (group.size() > 1 && commit_together(group)) return;
  for (Pending* each : group) commit_alone(*each, {});
}

/// Commits all actions in one transaction. Returns false if it failed and nothing was changed.
bool GroupCommit::commit_together(const Group& group) {
  try {
    Prepared(writer_, "BEGIN IMMEDIATE").exec();
    for (Pending* each : group) {
      Prepared(writer_, "SAVEPOINT one").exec();
      try {
        require_caller(*each->limits);
        (*each->action)(writer_);
      } catch (...) {
        each->error = std::current_exception();
        // Some errors, e.g. a full disk, roll back the whole transaction.
        if (!is_in_transaction(writer_)) return false;
        Prepared(writer_, "ROLLBACK TO one").exec();
      }
      Prepared(writer_, "RELEASE one").exec();
    }
    Prepared(writer_, "COMMIT").exec();
    return true;
  } catch (const SQLite::Exception&) {
    roll_back(writer_);
    return false;
  }
}

/// The limits apply to every statement up to the commit.
void GroupCommit::commit_alone(Pending& pending, const CallLimits& limits) {
  pending.error = nullptr;
  const Connection::Under under(writer_, limits);
  try {
    require_caller(*pending.limits);
    Prepared(writer_, "BEGIN IMMEDIATE").exec();
    (*pending.action)(writer_);
    Prepared(writer_, "COMMIT").exec();
  } catch (...) {
    pending.error = std::current_exception();
    roll_back(writer_);
  }
}

}  // namespace tribodyn::server
