#include "server/scheduling/stop_signal.h"

namespace tribodyn::server {

void StopSignal::request(StopReason reason) {
  StopReason none = StopReason::kNone;
  {
    const std::lock_guard lock(mutex_);
    reason_.compare_exchange_strong(none, reason);
  }
  requested_.notify_all();
}

bool StopSignal::wait_for(std::chrono::milliseconds time) const {
  std::unique_lock lock(mutex_);
  return !requested_.wait_for(lock, time, [this] { return requested(); });
}

}  // namespace tribodyn::server
