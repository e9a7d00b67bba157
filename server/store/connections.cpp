#include "server/store/connections.h"

namespace tribodyn::server {

ReaderPool::ReaderPool(std::filesystem::path database, int maximum)
    : database_(std::move(database)), maximum_(maximum) {}

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
