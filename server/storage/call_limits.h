#pragma once

#include <atomic>
#include <chrono>

namespace tribodyn::server {

/// How long a caller waits for the store: until a time, and until the caller gives up. A call of
/// the store that has not begun to commit by then throws StoreError kDeadline or kCancelled and has
/// changed nothing. The default is a caller that waits for ever.
struct CallLimits {
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::time_point kNever = Clock::time_point::max();

  Clock::time_point deadline = kNever;
  /// Set once the caller has given up; null: the caller never does. Must outlive all copies.
  const std::atomic<bool>* cancelled = nullptr;

  bool is_cancelled() const {
    return cancelled != nullptr && cancelled->load(std::memory_order_relaxed);
  }
  bool is_past_deadline() const { return deadline != kNever && Clock::now() >= deadline; }
  /// Returns whether nobody waits for the answer any more.
  bool are_over() const { return is_cancelled() || is_past_deadline(); }
};

}  // namespace tribodyn::server
