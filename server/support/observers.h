#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

namespace tribodyn::server {

/// Told that something changed; looks for itself what. Called on any thread, with no lock held;
/// must be quick and must not throw.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void changed() = 0;
};

/// Observers of one thing, each for as long as it lives. Safe for concurrent access.
class Observers {
 public:
  void add(const std::weak_ptr<Observer>& observer) {
    const std::lock_guard lock(mutex_);
    if (observers_.size() >= 2 * living_) {
      std::erase_if(observers_, [](const auto& weak) { return weak.expired(); });
      living_ = std::max(observers_.size(), kFewest);
    }
    observers_.push_back(observer);
  }

  /// Calls changed() of each. Tells nobody if no memory is left: observers also look by themselves
  /// now and then.
  void tell() const noexcept try {
    std::vector<std::shared_ptr<Observer>> told;
    {
      const std::lock_guard lock(mutex_);
      for (const auto& weak : observers_) {
        if (auto observer = weak.lock()) told.push_back(std::move(observer));
      }
    }
    for (const auto& observer : told) observer->changed();
  } catch (const std::bad_alloc&) {
    return;
  }

 private:
  static constexpr std::size_t kFewest = 4;  // observers that are kept although they may be gone

  mutable std::mutex mutex_;
  std::vector<std::weak_ptr<Observer>> observers_;  // guarded by mutex_
  // Guarded by mutex_; observers that were left when those that are gone were last removed: add()
  // takes constant time on average.
  std::size_t living_ = kFewest;
};

}  // namespace tribodyn::server
