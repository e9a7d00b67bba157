#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/storage/call_limits.h"

namespace tribodyn::server {

/// A connection with a cache of prepared statements: preparing a statement takes longer than most
/// statements run. Not safe for concurrent access.
class Connection : public SQLite::Database {
 public:
  using SQLite::Database::Database;

  /// Makes statements fail with SQLITE_INTERRUPT when the limits of an Under object are over. Call
  /// it once, before the first Under object.
  void heed_limits();

  /// Ends statements of the connection when `limits` are over, while the object exists. Only one
  /// object at a time.
  class Under {
   public:
    Under(Connection& connection, const CallLimits& limits) : connection_(connection) {
      connection_.limits_ = &limits;
    }
    ~Under() { connection_.limits_ = nullptr; }
    Under(const Under&) = delete;
    Under& operator=(const Under&) = delete;

   private:
    Connection& connection_;
  };

 private:
  friend class Prepared;
  using Statements = std::vector<std::unique_ptr<SQLite::Statement>>;
  const CallLimits* limits_ = nullptr;  // null: no limits
  // by SQL text; destroyed before the base class
  std::map<std::string, Statements, std::less<>> idle_;
};

/// A prepared statement of a connection. The destructor resets it and clears its values. Use it for
/// fixed texts only: statements are never removed from the cache. Throws SQLite::Exception.
class Prepared {
 public:
  Prepared(Connection& connection, std::string_view sql);
  ~Prepared();
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  template <class... Values>
  void bind(int index, Values&&... values) {
    statement_->bind(index, std::forward<Values>(values)...);
  }
  void bindNoCopy(int index, const void* bytes, int size) {
    statement_->bindNoCopy(index, bytes, size);
  }
  bool executeStep() { return statement_->executeStep(); }
  int exec() { return statement_->exec(); }
  void reset() { statement_->reset(); }
  SQLite::Column getColumn(int index) const { return statement_->getColumn(index); }
  operator SQLite::Statement&() { return *statement_; }              // NOLINT: converts implicitly
  operator const SQLite::Statement&() const { return *statement_; }  // NOLINT

 private:
  Connection::Statements& idle_;
  std::unique_ptr<SQLite::Statement> statement_;
};

}  // namespace tribodyn::server
