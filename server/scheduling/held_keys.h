#pragma once

#include <mutex>
#include <set>
#include <string>
#include <utility>

namespace tribodyn::server {

/// Keys each of which is held for a time, by one or several. Safe for concurrent access without
/// external synchronization.
class HeldKeys {
 public:
  /// Holds a key as long as it lives.
  class Hold {
   public:
    Hold(HeldKeys& keys, std::string key) : keys_(keys), key_(std::move(key)) {
      const std::lock_guard lock(keys_.mutex_);
      keys_.held_.insert(key_);
    }
    ~Hold() {
      const std::lock_guard lock(keys_.mutex_);
      keys_.held_.erase(keys_.held_.find(key_));
    }
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

   private:
    HeldKeys& keys_;
    const std::string key_;
  };

  bool contains(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    return held_.contains(key);
  }

 private:
  mutable std::mutex mutex_;
  std::multiset<std::string> held_;  // guarded by mutex_
};

}  // namespace tribodyn::server
