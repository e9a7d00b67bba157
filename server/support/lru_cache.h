#pragma once

#include <algorithm>
#include <cstddef>
#include <list>
#include <mutex>
#include <utility>

namespace tribodyn::server {

/// Cache of at most kCapacity values; it drops the least recently used one. Safe for concurrent
/// access. Two threads that miss the same key at the same time both call `make`.
template <class Key, class Value>
class LruCache {
 public:
  /// Returns the cached value of `key`, or stores and returns `make()`.
  template <class Make>
  Value get(const Key& key, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      const auto found = std::find_if(entries_.begin(), entries_.end(),
                                      [&](const auto& each) { return each.first == key; });
      if (found != entries_.end()) {
        entries_.splice(entries_.begin(), entries_, found);
        return entries_.front().second;
      }
    }
    Value value = make();
    const std::lock_guard lock(mutex_);
    entries_.emplace_front(key, value);
    if (entries_.size() > kCapacity) entries_.pop_back();
    return value;
  }

 private:
  static constexpr std::size_t kCapacity = 16;

  std::mutex mutex_;
  std::list<std::pair<Key, Value>> entries_;  // guarded by mutex_; most recently used first
};

}  // namespace tribodyn::server
