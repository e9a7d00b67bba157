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

/// A connection that keeps the statements it has prepared, as preparing one takes longer than most
/// take to run. Not safe for concurrent access.
class Connection : public SQLite::Database {
 public:
  using SQLite::Database::Database;

  /// Makes statements fail with SQLITE_INTERRUPT while the limits that an Under set are over. Once,
  /// before the first of them.
  void heed_limits();

  /// While it lives, statements of the connection end when `limits` are over. One at a time.
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
  const CallLimits* limits_ = nullptr;                   // null: none
  std::map<std::string, Statements, std::less<>> idle_;  // by their text; gone before the base
};

/// A statement of a connection for the time of a scope, at the end of which it is reset and its
/// values are forgotten. For fixed texts only: nothing ever drops them. Throws SQLite::Exception.
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
  operator SQLite::Statement&() { return *statement_; }              // NOLINT: stands for it
  operator const SQLite::Statement&() const { return *statement_; }  // NOLINT

 private:
  Connection::Statements& idle_;
  std::unique_ptr<SQLite::Statement> statement_;
};

}  // namespace tribodyn::server
