#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/application/authorizer.h"
#include "server/storage/token_table.h"

namespace tribodyn::server {

/// Brings changes of the tokens, also those of other processes, to an Authorizer while the server
/// runs, and acknowledges them. A thread of its own looks for changes every 50 ms.
class TokenWatch {
 public:
  /// Applies the tokens before it returns. Both arguments must outlive the object; nothing else may
  /// use `tokens`. Throws StoreError.
  TokenWatch(TokenTable& tokens, Authorizer& authorizer);
  ~TokenWatch();
  TokenWatch(const TokenWatch&) = delete;
  TokenWatch& operator=(const TokenWatch&) = delete;

 private:
  void apply();
  void run();

  TokenTable& tokens_;
  Authorizer& authorizer_;
  std::int64_t applied_ = -1;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_stopped_ = false;  // guarded by mutex_
  std::thread thread_;       // last: it uses all of the above
};

}  // namespace tribodyn::server
