#pragma once

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "server/scheduling/stop_signal.h"
#include "server/storage/store_error.h"

namespace tribodyn::server {

/// Repeats an action on behalf of a simulation while the action throws StoreError, with growing
/// pauses. Rethrows the error once the simulation is asked to stop. Returns what the action
/// returns.
template <class Action>
auto retry_on_store_error(std::int64_t id, const StopSignal& stop, const Action& action) {
  using std::chrono::milliseconds;
  constexpr milliseconds kFirstPause(100), kLongestPause(30'000);
  for (auto pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
    try {
      return action();
    } catch (const StoreError& error) {
      spdlog::error("simulation of row {}: {}", id, error.what());
      if (!stop.wait_for(pause)) throw;
    }
  }
}

}  // namespace tribodyn::server
