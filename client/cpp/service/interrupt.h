#pragma once

namespace tribodyn::client {

/// Handles Ctrl-C and SIGTERM during its lifetime: the first sets interrupted(), a second ends the
/// process. At most one may exist at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  static bool interrupted();
};

}  // namespace tribodyn::client
