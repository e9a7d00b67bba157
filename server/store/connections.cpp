#include "server/store/connections.h"

#include <sqlite3.h>

#include "server/store/deadline.h"

namespace tribodyn::server {

ReaderPool::ReaderPool(std::filesystem::path database, int maximum)
    : database_(std::move(database)), maximum_(maximum) {}

void heed_deadlines(SQLite::Database& connection) {
  constexpr int kInstructions = 1000;  // about 10 us between looks at the clock
  sqlite3_progress_handler(
      connection.getHandle(), kInstructions,
      [](void*) { return DeadlineScope::has_passed() ? 1 : 0; }, nullptr);
}

ReaderPool::Loan ReaderPool::borrow() {
  {
    std::unique_lock lock(mutex_);
    returned_.wait(lock, [this] { return !idle_.empty() || open_ < maximum_; });
    if (!idle_.empty()) {
      auto connection = std::move(idle_.back());
      idle_.pop_back();
      return Loan(*this, std::move(connection));
    }
    ++open_;
  }
  try {
    // Read-write at the file level, as a WAL reader may have to rebuild the index; query_only bars
    // it from changing anything.
    auto connection = std::make_unique<SQLite::Database>(database_.string(), SQLite::OPEN_READWRITE,
                                                         kBusyTimeoutMilliseconds);
    connection->exec("PRAGMA query_only = ON");
    // In KiB: what many readers of histories share comes from the system's cache.
    connection->exec("PRAGMA cache_size = -256");
    heed_deadlines(*connection);
    return Loan(*this, std::move(connection));
  } catch (...) {
    give_back(nullptr);
    throw;
  }
}

void ReaderPool::give_back(std::unique_ptr<SQLite::Database> connection) {
  {
    const std::lock_guard lock(mutex_);
    if (connection) {
      idle_.push_back(std::move(connection));
    } else {
      --open_;
    }
  }
  returned_.notify_one();
}

}  // namespace tribodyn::server
