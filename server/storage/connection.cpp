#include "server/storage/connection.h"

namespace tribodyn::server {

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
  statement_->tryReset();  // an error of the last step was thrown then
  statement_->clearBindings();
  idle_.push_back(std::move(statement_));
}

}  // namespace tribodyn::server
