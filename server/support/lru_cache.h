#pragma once

#include <algorithm>
#include <cstddef>
#include <list>
#include <mutex>
#include <utility>

namespace tribodyn::server {

/// An LRU cache of kMostKept values. Safe for concurrent access; two threads that miss the same key
/// at once both make the value.
template <class Key, class Value>
class LruCache {
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
