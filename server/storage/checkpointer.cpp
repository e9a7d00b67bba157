#include "server/storage/checkpointer.h"

#include <sqlite3.h>

#include "server/storage/connections.h"

namespace tribodyn::server {
namespace {

/// Copies of the log one after the other. The first one copies most of the pages; meanwhile commits
/// add some. When the last one ends, the log is most likely copied as a whole, and the next commit
/// begins at its start again.
constexpr int kCopies = 2;

/// Copies what no reader needs from the log. Errors are left to the next checkpoint.
void checkpoint(sqlite3* database, const char* schema) {
  sqlite3_wal_checkpoint_v2(database, schema, SQLITE_CHECKPOINT_PASSIVE, nullptr, nullptr);
}

}  // namespace

Checkpointer::Checkpointer(const std::filesystem::path& database, Connection& writer)
    : writer_(writer),
      connection_(database.string(), SQLite::OPEN_READWRITE, kBusyTimeoutMilliseconds) {
  connection_.exec("PRAGMA synchronous = FULL");
  connection_.execAndGet("SELECT count(*) FROM sqlite_master");  // opens the write-ahead log too
  sqlite3_wal_hook(writer_.getHandle(), &Checkpointer::after_commit, this);
  thread_ = std::thread([this] { run(); });
}

Checkpointer::~Checkpointer() {
  sqlite3_wal_autocheckpoint(writer_.getHandle(), kPages);  // removes the hook
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

int Checkpointer::after_commit(void* self, sqlite3* writer, const char* schema, int pages) {
  auto& checkpointer = *static_cast<Checkpointer*>(self);
  if (pages < checkpointer.last_pages_) checkpointer.next_pages_ = kPages;  // the log began anew
  checkpointer.last_pages_ = pages;
  if (pages >= kMostPages) {
    const std::lock_guard no_copy(checkpointer.copy_mutex_);
    checkpoint(writer, schema);
  } else if (pages >= checkpointer.next_pages_) {
    checkpointer.next_pages_ = pages + kPages;
    {
      const std::lock_guard lock(checkpointer.mutex_);
      checkpointer.is_wanted_ = true;
    }
    checkpointer.changed_.notify_one();
  }
  return SQLITE_OK;
}

void Checkpointer::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_wanted_ || is_ending_; });
    if (is_ending_) return;
    is_wanted_ = false;
    lock.unlock();
    {
      const std::lock_guard copy(copy_mutex_);
      for (int i = 0; i < kCopies; ++i) checkpoint(connection_.getHandle(), "main");
    }
    lock.lock();
  }
}

}  // namespace tribodyn::server
