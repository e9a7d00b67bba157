#include "server/daemon/token_watch.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>

namespace tribodyn::server {
namespace {

// A look takes about 10 us. The commands that change tokens wait for the acknowledgement.
constexpr auto kTokenWatchInterval = std::chrono::milliseconds(50);

}  // namespace

TokenWatch::TokenWatch(TokenTable& tokens, Authorizer& authorizer)
    : tokens_(tokens), authorizer_(authorizer) {
  apply();
  thread_ = std::thread([this] { run(); });
}

TokenWatch::~TokenWatch() {
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void TokenWatch::apply() {
  const std::int64_t change = tokens_.change();
  if (change == applied_) return;
  authorizer_.set_tokens(tokens_.all(), system_time());
  applied_ = change;
  if (tokens_.acknowledged_change() != change) tokens_.acknowledge(change);
}

void TokenWatch::run() {
  bool has_failed = false;
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kTokenWatchInterval, [this] { return is_stopped_; })) {
    try {
      apply();
      has_failed = false;
    } catch (const std::exception& failure) {
      if (!has_failed) spdlog::error("event=tokens_not_read cause=\"{}\"", failure.what());
      has_failed = true;
    }
  }
}

}  // namespace tribodyn::server
