#pragma once

#include <condition_variable>
#include <mutex>

namespace tribodyn::server {

/// Lets a limited number of threads compute at once. The others sleep meanwhile, so that threads
/// which receive and send messages need not compete with all of them for a processor. A Lockable of
/// the standard library, for std::unique_lock; safe for concurrent access. (In libstdc++ 12 a
/// thread that waits for a std::counting_semaphore can miss its release: GCC bug 104928.)
class ProcessorSlots {
 public:
  /// Requires at least one slot.
  explicit ProcessorSlots(int slots) : free_(slots) {}
  void lock() {
    std::unique_lock lock(mutex_);
    released_.wait(lock, [this] { return free_ > 0; });
    --free_;
  }
  void unlock() {
    {
      const std::lock_guard lock(mutex_);
      ++free_;
    }
    released_.notify_one();
  }

 private:
  std::mutex mutex_;
  std::condition_variable released_;
  int free_;  // guarded by mutex_
};

}  // namespace tribodyn::server
