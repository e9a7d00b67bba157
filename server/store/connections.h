#pragma once

#include <SQLiteCpp/Database.h>

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

namespace tribodyn::server {

/// Read-only connections to one database, lent to one thread at a time.
/// Safe for concurrent access without external synchronization.
class ReaderPool {
 public:
  /// At most `maximum` connections; further readers wait for one.
  ReaderPool(std::filesystem::path database, int maximum);

  /// A connection on loan; goes back when the loan ends.
  class Loan {
   public:
    Loan(ReaderPool& pool, std::unique_ptr<SQLite::Database> connection)
        : pool_(pool), connection_(std::move(connection)) {}
    ~Loan() { pool_.give_back(std::move(connection_)); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    SQLite::Database& operator*() { return *connection_; }

   private:
    ReaderPool& pool_;
    std::unique_ptr<SQLite::Database> connection_;
  };

  Loan borrow();

 private:
  void give_back(std::unique_ptr<SQLite::Database> connection);

  const std::filesystem::path database_;
  const int maximum_;
  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<SQLite::Database>> idle_;  // guarded by mutex_
  int open_ = 0;                                         // guarded by mutex_
};

/// Makes statements of a connection end when the deadline of their thread passes (deadline.h).
void heed_deadlines(SQLite::Database& connection);

/// How long a statement waits for another connection before it fails [ms].
inline constexpr int kBusyTimeoutMilliseconds = 5000;

}  // namespace tribodyn::server
