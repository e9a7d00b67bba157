#pragma once

#include <chrono>
#include <optional>

namespace tribodyn::server {

/// While it lives, whatever this thread asks of the store ends with StoreError kDeadline, and has
/// changed nothing, once the time has come. Scopes nest; the earliest end counts.
class DeadlineScope {
 public:
  using Clock = std::chrono::steady_clock;
  explicit DeadlineScope(Clock::time_point end);
  ~DeadlineScope();
  DeadlineScope(const DeadlineScope&) = delete;
  DeadlineScope& operator=(const DeadlineScope&) = delete;

  /// Whether the time of this thread's scope, if it is in one, has come.
  static bool has_passed();

 private:
  std::optional<Clock::time_point> outer_;
};

}  // namespace tribodyn::server
