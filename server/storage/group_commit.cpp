#include "server/storage/group_commit.h"

#include <sqlite3.h>

#include <algorithm>

#include "server/storage/connections.h"

namespace tribodyn::server {
namespace {

constexpr std::size_t kLargestGroup = 64;

bool is_in_transaction(Connection& db) { return sqlite3_get_autocommit(db.getHandle()) == 0; }

void roll_back(Connection& db) {
  if (is_in_transaction(db)) db.tryExec("ROLLBACK");
}

/// While it lives, statements do not end at the deadline of this thread, which is not theirs.
class WithoutDeadlines {
 public:
  explicit WithoutDeadlines(Connection& db) : db_(db) {
    sqlite3_progress_handler(db_.getHandle(), 0, nullptr, nullptr);
  }
  ~WithoutDeadlines() { heed_deadlines(db_); }
  WithoutDeadlines(const WithoutDeadlines&) = delete;
  WithoutDeadlines& operator=(const WithoutDeadlines&) = delete;

 private:
  Connection& db_;
};

}  // namespace

void GroupCommit::run(const Action& action) {
  Pending own{&action};
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
  if (is_own) return commit_alone(*group.front());
  const WithoutDeadlines without_deadlines(writer_);
  if (group.size() > 1 && commit_together(group)) return;
  for (Pending* each : group) commit_alone(*each);
}

/// False when nothing of it has changed anything.
bool GroupCommit::commit_together(const Group& group) {
  try {
    Prepared(writer_, "BEGIN IMMEDIATE").exec();
    for (Pending* each : group) {
      Prepared(writer_, "SAVEPOINT one").exec();
      try {
        (*each->action)(writer_);
      } catch (...) {
        each->error = std::current_exception();
        // Some failures undo everything, e.g. a full disk.
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

void GroupCommit::commit_alone(Pending& pending) {
  pending.error = nullptr;
  try {
    Prepared(writer_, "BEGIN IMMEDIATE").exec();
    (*pending.action)(writer_);
    Prepared(writer_, "COMMIT").exec();
  } catch (...) {
    pending.error = std::current_exception();
    roll_back(writer_);
  }
}

}  // namespace tribodyn::server
