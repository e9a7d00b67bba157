#pragma once

#include <semaphore>

namespace tribodyn::server {

/// Lets a limited number of threads compute at once. The others sleep meanwhile, so that threads
/// which receive and send messages need not compete with all of them for a processor. A Lockable of
/// the standard library, for std::unique_lock; safe for concurrent access.
class ProcessorSlots {
 public:
  /// Requires at least one slot.
  explicit ProcessorSlots(int slots) : free_(slots) {}
  void lock() { free_.acquire(); }
  void unlock() { free_.release(); }

 private:
  std::counting_semaphore<> free_;
};

}  // namespace tribodyn::server
