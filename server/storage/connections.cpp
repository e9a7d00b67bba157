#include "server/storage/connections.h"

#include <sqlite3.h>

#include <chrono>

namespace tribodyn::server {
namespace {

/// Interval between two checks of the limits of a caller who waits for a connection.
constexpr auto kBetweenLooks = std::chrono::milliseconds(20);

}  // namespace

void configure_sqlite() {
  // Has no effect if SQLite is already in use, e.g. in a test.
  sqlite3_config(SQLITE_CONFIG_MULTITHREAD);
  sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0);
}

void ReaderPool::open(const std::filesystem::path& database, int connections) {
  for (int i = 0; i < connections; ++i) {
    // The file is opened for writing because a WAL reader may have to rebuild the index; query_only
    // prevents changes.
    auto connection = std::make_unique<Connection>(database.string(), SQLite::OPEN_READWRITE,
                                                   kBusyTimeoutMilliseconds);
    connection->exec("PRAGMA query_only = ON");
    // In KiB. Readers of histories share the system's cache, so a small one suffices.
    connection->exec("PRAGMA cache_size = -256");
    connection->execAndGet("SELECT count(*) FROM sqlite_master");  // opens the write-ahead log too
    connection->heed_limits();
    give_back(std::move(connection));
  }
}

ReaderPool::Loan ReaderPool::borrow(const CallLimits& limits) {
  std::unique_lock lock(mutex_);
  const auto is_there = [this] { return !idle_.empty(); };
  while (!returned_.wait_for(lock, kBetweenLooks, is_there)) {
    if (limits.are_over()) return Loan(*this, nullptr);
  }
  auto connection = std::move(idle_.back());
  idle_.pop_back();
  return Loan(*this, std::move(connection));
}

void ReaderPool::give_back(std::unique_ptr<Connection> connection) {
  {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(connection));
  }
  returned_.notify_one();
}

}  // namespace tribodyn::server
