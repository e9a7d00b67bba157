#include "server/storage/connection.h"

#include <sqlite3.h>

namespace tribodyn::server {

void Connection::heed_limits() {
  constexpr int kInstructions = 1000;  // instructions between two checks, about 10 us
  sqlite3_progress_handler(
      getHandle(), kInstructions,
      [](void* limits) {
        const auto* present = *static_cast<const CallLimits**>(limits);
        return present != nullptr && present->are_over() ? 1 : 0;
      },
      &limits_);
}

Prepared::Prepared(Connection& connection, std::string_view sql)
    : idle_([&]() -> Connection::Statements& {
        const auto found = connection.idle_.find(sql);
        if (found != connection.idle_.end()) return found->second;
        return connection.idle_[std::string(sql)];
      }()) {
  if (idle_.empty()) {
    statement_ = std::make_unique<SQLite::Statement>(connection, std::string(sql));
  } else {
    statement_ = std::move(idle_.back());
    idle_.pop_back();
  }
}

Prepared::~Prepared() {
  statement_->tryReset();  // tryReset: an error of the last step was already thrown
  statement_->clearBindings();
  idle_.push_back(std::move(statement_));
}

std::optional<std::int64_t> Prepared::returned() {
  const auto out = first([](SQLite::Statement& row) { return row.getColumn(0).getInt64(); });
  if (out) executeStep();  // to its end: only then is the change done
  return out;
}

}  // namespace tribodyn::server
