#pragma once

#include <cstddef>
#include <functional>
#include <limits>

#include "server/application/workers.h"

namespace tribodyn::server {

/// Which threads answer a call. A call waits for the other calls of its lane only.
enum class CallLane {
  kRead,    ///< takes less than a millisecond or so
  kWrite,   ///< waits for the disk
  kSearch,  ///< looks at many rows, or computes
  kHeavy,   ///< a batch, an import, or any large request
  kStream,  ///< the next message of a stream
};

/// The threads of all lanes. Safe for concurrent access; the destructor runs what was accepted.
class CallLanes {
 public:
  /// How many calls may wait in a lane, and in that of heavy calls.
  static constexpr std::size_t kWaiting = 10'000;  // small requests take gRPC a few kB each
  static constexpr std::size_t kHeavyWaiting = 64;
  /// Bytes of heavy requests, waiting and under way: two of the largest. Parsed, they take some 30
  /// times as much.
  static constexpr std::size_t kHeavyBytes = 128 << 20;

  /// Runs `task` on a thread of the lane. Returns false, and leaves `task` as it is, if the lane is
  /// full; that of streams never is.
  bool run(CallLane lane, std::size_t bytes, std::function<void()>& task) {
    return workers_[static_cast<std::size_t>(lane)].run(bytes, task);
  }

 private:
  static constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

  // In the order of CallLane. More threads than these only wait for the processors; writers share
  // their commits.
  Workers workers_[5] = {{4, kWaiting, kUnlimited},
                         {8, kWaiting, kUnlimited},
                         {2, kWaiting, kUnlimited},
                         {2, kHeavyWaiting, kHeavyBytes},
                         {2, kUnlimited, kUnlimited}};  // one task at most for each open stream
};

}  // namespace tribodyn::server
