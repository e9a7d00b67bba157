#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
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

/// Bytes to be bound as a BLOB: a string is bound as TEXT. SQLite copies them only when the
/// statement runs.
struct Blob {
  std::string_view bytes;
};

inline void bind_value(SQLite::Statement& statement, int index, const Blob& blob) {
  statement.bindNoCopy(index, blob.bytes.data(), static_cast<int>(blob.bytes.size()));
}
/// Binds an enum as its number, any other value as it is.
template <class Value>
void bind_value(SQLite::Statement& statement, int index, const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    statement.bind(index, static_cast<int>(value));
  } else {
    statement.bind(index, value);
  }
}
/// Binds NULL if there is no value.
template <class Value>
void bind_value(SQLite::Statement& statement, int index, const std::optional<Value>& value) {
  value ? bind_value(statement, index, *value) : statement.bind(index);
}
template <class... Values>
void bind_value(SQLite::Statement& statement, int index, const std::variant<Values...>& value) {
  std::visit([&](const auto& held) { bind_value(statement, index, held); }, value);
}

/// Binds the values to the first parameters of a statement. Returns their number.
template <class Value>
int bind_values(SQLite::Statement& statement, const std::vector<Value>& values) {
  int index = 0;
  for (const Value& value : values) bind_value(statement, ++index, value);
  return index;
}

/// A prepared statement of a connection. The destructor resets it and clears its values. Use it for
/// fixed texts only: statements are never removed from the cache. Throws SQLite::Exception.
class Prepared {
 public:
  Prepared(Connection& connection, std::string_view sql);
  /// Binds the values as bind_value() does, the first to ?1.
  template <class... Values>
  requires(sizeof...(Values) > 0)
      Prepared(Connection& connection, std::string_view sql, const Values&... values)
      : Prepared(connection, sql) {
    bind(values...);
  }
  ~Prepared();
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  bool executeStep() { return statement_->executeStep(); }
  int exec() { return statement_->exec(); }
  void reset() { statement_->reset(); }
  SQLite::Column getColumn(int index) const { return statement_->getColumn(index); }
  operator SQLite::Statement&() { return *statement_; }  // NOLINT: converts implicitly

  /// Runs the statement with these values, and makes it ready for the next ones.
  template <class... Values>
  void run(const Values&... values) {
    bind(values...);
    exec();
    reset();
  }
  /// Returns the first column of the first row, which must exist.
  SQLite::Column value() {
    executeStep();
    return getColumn(0);
  }
  /// Returns what `read` makes of the first row; nullopt if there is none.
  template <class Read>
  auto first(const Read& read)
      -> std::optional<std::invoke_result_t<const Read&, SQLite::Statement&>> {
    if (!executeStep()) return std::nullopt;
    return read(*statement_);
  }
  /// Returns the first column of the row that a change returns, and completes the change; nullopt
  /// if it changes no row.
  std::optional<std::int64_t> returned();

 private:
  template <class... Values>
  void bind(const Values&... values) {
    int index = 0;
    (bind_value(*statement_, ++index, values), ...);
  }

  Connection::Statements& idle_;
  std::unique_ptr<SQLite::Statement> statement_;
};

/// Runs a statement that returns no rows. Returns the number of rows that it changed.
template <class... Values>
int execute(Connection& connection, std::string_view sql, const Values&... values) {
  return Prepared(connection, sql, values...).exec();
}

}  // namespace tribodyn::server
