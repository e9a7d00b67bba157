#include "server/storage/token_table.h"

#include <SQLiteCpp/Transaction.h>

#include "server/storage/connections.h"
#include "server/storage/database_check.h"
#include "server/storage/store_error.h"
#include "server/storage/translate_error.h"

namespace tribodyn::server {
namespace {

constexpr char kValid[] = "revoke_time IS NULL AND (expire_time IS NULL OR expire_time > ?2)";

Connection open_for_tokens(const std::filesystem::path& path) try {
  return {path.string(), SQLite::OPEN_READWRITE, kBusyTimeoutMilliseconds};
} catch (const SQLite::Exception& error) {
  throw translate_error(error, path);
}

std::string joined(const std::vector<std::string>& projects) {
  std::string out;
  for (const std::string& each : projects) out += (out.empty() ? "" : ",") + each;
  return out;
}

std::vector<std::string> split(const std::string& projects) {
  std::vector<std::string> out;
  for (std::size_t begin = 0; begin < projects.size();) {
    const std::size_t end = std::min(projects.find(',', begin), projects.size());
    out.push_back(projects.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

std::optional<Microseconds> time_in(const SQLite::Column& column) {
  if (column.isNull()) return std::nullopt;
  return column.getInt64();
}

void insert_token(Connection& db, const StoredToken& token) {
  execute(db,
          "INSERT INTO tokens (hash, name, scope, projects, create_time, expire_time, "
          "calls_per_second, streams, processor_hours) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
          token.hash, token.name, token.scope, joined(token.projects), token.create_time,
          token.expire_time, token.calls_per_second, token.streams, token.processor_hours);
}

bool has_valid_token(Connection& db, const std::string& name, Microseconds now) {
  Prepared query(db, std::string("SELECT 1 FROM tokens WHERE name = ?1 AND ") + kValid, name, now);
  return query.executeStep();
}

void count_change(Connection& db) { db.exec("UPDATE token_log SET change = change + 1"); }

}  // namespace

template <class Action>
auto TokenTable::translated(const Action& action) {
  try {
    return action();
  } catch (const SQLite::Exception& error) {
    throw translate_error(error, path_);
  }
}

TokenTable::TokenTable(const std::filesystem::path& database, const SchemaSteps& steps)
    : path_(database), connection_(open_for_tokens(database)) {
  translated([&] {
    check_identity(connection_, path_, steps);
    const int version = connection_.execAndGet("PRAGMA user_version").getInt();
    if (version < static_cast<int>(steps.size())) {
      throw StoreError(StoreError::Kind::kFailed,
                       "database " + path_.string() + " has schema " + std::to_string(version) +
                           ", used by an older tribodynd; stop that one first");
    }
    connection_.exec("PRAGMA synchronous = FULL");
  });
}

std::vector<StoredToken> TokenTable::all() {
  return translated([this] {
    Prepared query(
        connection_,
        "SELECT name, hash, scope, projects, create_time, expire_time, revoke_time, "
        "calls_per_second, streams, processor_hours FROM tokens ORDER BY name, create_time, hash");
    std::vector<StoredToken> out;
    while (query.executeStep()) {
      out.push_back({.name = query.getColumn(0).getString(),
                     .hash = query.getColumn(1).getString(),
                     .scope = static_cast<Scope>(query.getColumn(2).getInt()),
                     .projects = split(query.getColumn(3).getString()),
                     .create_time = query.getColumn(4).getInt64(),
                     .expire_time = time_in(query.getColumn(5)),
                     .revoke_time = time_in(query.getColumn(6))});
      const auto number = [&query](int index) -> std::optional<double> {
        const SQLite::Column column = query.getColumn(index);
        if (column.isNull()) return std::nullopt;
        return column.getDouble();
      };
      out.back().calls_per_second = number(7);
      if (const auto streams = number(8)) out.back().streams = static_cast<int>(*streams);
      out.back().processor_hours = number(9);
    }
    return out;
  });
}

bool TokenTable::add(const StoredToken& token) {
  return translated([&] {
    SQLite::Transaction transaction(connection_, SQLite::TransactionBehavior::IMMEDIATE);
    if (has_valid_token(connection_, token.name, token.create_time)) return false;
    insert_token(connection_, token);
    count_change(connection_);
    transaction.commit();
    return true;
  });
}

bool TokenTable::replace(const StoredToken& token, Microseconds end) {
  return translated([&] {
    SQLite::Transaction transaction(connection_, SQLite::TransactionBehavior::IMMEDIATE);
    if (!has_valid_token(connection_, token.name, token.create_time)) return false;
    execute(connection_,
            std::string("UPDATE tokens SET revoke_time = CASE WHEN ?3 <= ?2 THEN ?2 END, "
                        "expire_time = CASE WHEN ?3 <= ?2 THEN expire_time "
                        "ELSE min(coalesce(expire_time, ?3), ?3) END WHERE name = ?1 AND ") +
                kValid,
            token.name, token.create_time, end);
    insert_token(connection_, token);
    count_change(connection_);
    transaction.commit();
    return true;
  });
}

int TokenTable::revoke(const std::string& name, Microseconds now) {
  return translated([&] {
    SQLite::Transaction transaction(connection_, SQLite::TransactionBehavior::IMMEDIATE);
    const int count = execute(connection_,
                              std::string("UPDATE tokens SET revoke_time = ?2 WHERE name = ?1 "
                                          "AND ") +
                                  kValid,
                              name, now);
    count_change(connection_);
    transaction.commit();
    return count;
  });
}

std::int64_t TokenTable::change() {
  return translated([this] {
    const auto single = [this](const char* sql) {
      Prepared query(connection_, sql);
      query.executeStep();
      return query.getColumn(0).getInt64();
    };
    const std::int64_t version = single("PRAGMA data_version");
    if (version != seen_version_) {
      seen_change_ = single("SELECT change FROM token_log");
      seen_version_ = version;
    }
    return seen_change_;
  });
}

std::int64_t TokenTable::acknowledged_change() {
  return translated(
      [this] { return connection_.execAndGet("SELECT acknowledged FROM token_log").getInt64(); });
}

void TokenTable::acknowledge(std::int64_t change) {
  translated([&] { execute(connection_, "UPDATE token_log SET acknowledged = ?", change); });
}

std::string TokenTable::page_token_key() {
  return translated([this] {
    return connection_.execAndGet("SELECT page_token_key FROM token_log").getString();
  });
}

}  // namespace tribodyn::server
