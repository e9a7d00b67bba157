#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include "server/storage/connection.h"

namespace tribodyn::server {

/// Read-only connections to one database, lent to one thread at a time; readers wait for one.
/// Safe for concurrent access without external synchronization, once open.
class ReaderPool {
 public:
  /// All of them at once, so that later nothing is left to fail or to be opened. The database must
  /// be there. Throws SQLite::Exception.
  void open(const std::filesystem::path& database, int connections);

  /// A connection on loan; goes back when the loan ends.
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

  /// Waits for a connection; the loan is empty if `limits` were over before one came back.
  Loan borrow(const CallLimits& limits);

 private:
  void give_back(std::unique_ptr<Connection> connection);

  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<Connection>> idle_;  // guarded by mutex_
};

/// Before the first connection of the process: ours are used by one thread at a time, and nobody
/// asks for SQLite's account of its memory, so that it needs no locks around either.
void configure_sqlite();

/// How long a statement waits for another connection before it fails [ms].
inline constexpr int kBusyTimeoutMilliseconds = 5000;

}  // namespace tribodyn::server
