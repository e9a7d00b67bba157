#pragma once

namespace tribodyn::client {

/// While one lives, Ctrl-C and SIGTERM are noted instead of ending the process; a second Ctrl-C
/// ends it. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  static bool interrupted();
};

}  // namespace tribodyn::client
