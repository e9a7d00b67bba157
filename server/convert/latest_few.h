#pragma once

#include <algorithm>
#include <cstddef>
#include <list>
#include <mutex>
#include <utility>

namespace tribodyn::server {

/// Values that take long to make and are asked for again and again: keeps the latest few. Safe for
/// concurrent access; a value may be made twice where two ask for it at once.
template <class Key, class Value>
class LatestFew {
 public:
  template <class Make>
  Value get(const Key& key, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      const auto found = std::find_if(kept_.begin(), kept_.end(),
                                      [&](const auto& each) { return each.first == key; });
      if (found != kept_.end()) {
        kept_.splice(kept_.begin(), kept_, found);
        return kept_.front().second;
      }
    }
    Value value = make();
    const std::lock_guard lock(mutex_);
    kept_.emplace_front(key, value);
    if (kept_.size() > kMostKept) kept_.pop_back();
    return value;
  }

 private:
  static constexpr std::size_t kMostKept = 16;

  std::mutex mutex_;
  std::list<std::pair<Key, Value>> kept_;  // guarded by mutex_; latest first
};

}  // namespace tribodyn::server
