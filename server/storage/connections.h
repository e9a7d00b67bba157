#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include "server/storage/connection.h"

namespace tribodyn::server {

/// A pool of read-only connections to one database. Each is lent to one thread at a time; readers
/// wait for a free one. Once open, safe for concurrent access without external synchronization.
class ReaderPool {
 public:
  /// Opens all connections at once, so that no later call can fail for want of one. Requires that
  /// the database exists. Throws SQLite::Exception.
  void open(const std::filesystem::path& database, int connections);

  /// A lent connection. The destructor returns it to the pool.
  class Loan {
   public:
    Loan(ReaderPool& pool, std::unique_ptr<Connection> connection)
        : pool_(pool), connection_(std::move(connection)) {}
    ~Loan() {
      if (connection_) pool_.give_back(std::move(connection_));
    }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    explicit operator bool() const { return connection_ != nullptr; }
    Connection& operator*() { return *connection_; }

   private:
    ReaderPool& pool_;
    std::unique_ptr<Connection> connection_;
  };

  /// Waits for a free connection. The loan is empty if `limits` were over before.
  Loan borrow(const CallLimits& limits);

 private:
  void give_back(std::unique_ptr<Connection> connection);

  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<Connection>> idle_;  // guarded by mutex_
};

/// Configures SQLite. Requires that the process has no connection yet. Each connection is used by
/// one thread at a time and SQLite's memory statistics are not used, so SQLite needs no locks for
/// either.
void configure_sqlite();

/// Longest wait of a statement for another connection [ms].
inline constexpr int kBusyTimeoutMilliseconds = 5000;

}  // namespace tribodyn::server
