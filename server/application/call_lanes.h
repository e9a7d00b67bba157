#pragma once

#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "server/application/workers.h"
#include "server/metrics/metrics.h"

namespace tribodyn::server {

/// The group of threads that answers a call. A call waits only for other calls of its lane.
enum class CallLane {
  kRead,     ///< takes about a millisecond or less
  kWrite,    ///< waits for the disk
  kSearch,   ///< reads many rows, or computes for some milliseconds
  kHeavy,    ///< a batch, an import, or any large request
  kCompute,  ///< computes for up to seconds
  kStream,   ///< the next message of a stream
};

/// The threads of all lanes. Safe for concurrent access. The destructor runs the accepted tasks.
class CallLanes {
 public:
  /// Largest number of waiting calls in a lane, and in those of heavy and of computing calls.
  static constexpr std::size_t kWaiting = 10'000;  // small requests take gRPC a few kB each
  static constexpr std::size_t kHeavyWaiting = 64;
  /// Largest size of all heavy requests that wait or run [bytes]: two of the longest. Parsed, they
  /// take about 30 times as much memory.
  static constexpr std::size_t kHeavyBytes = 128 << 20;

  /// Queues `task` for a thread of the lane, in which principals take turns. Returns false, and
  /// does not change `task`, if the lane is full. The lane of streams is never full.
  bool run(CallLane lane, std::size_t bytes, std::function<void()>& task,
           const std::string& principal = {}) {
    return workers_[static_cast<std::size_t>(lane)].run(bytes, task, principal);
  }
  /// Returns true if no task of the lane waits.
  bool is_empty(CallLane lane) { return workers_[static_cast<std::size_t>(lane)].is_empty(); }
  /// Returns the number of calls in each lane; streams count while a message of theirs is made.
  std::vector<LaneOccupancy> occupancy() {
    constexpr const char* kNames[] = {"read", "write", "search", "heavy", "compute", "stream"};
    std::vector<LaneOccupancy> out;
    for (std::size_t i = 0; i < std::size(kNames); ++i) {
      const Workers::Load load = workers_[i].load();
      out.push_back({kNames[i], load.waiting, load.running});
    }
    return out;
  }

 private:
  static constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max() / 2;

  // In the order of CallLane: threads, waiting tasks, bytes. More threads would only wait for the
  // processors; eight writers share their commits.
  Workers workers_[6] = {{4, kWaiting, kUnlimited},
                         {8, kWaiting, kUnlimited},
                         {2, kWaiting, kUnlimited},
                         {2, kHeavyWaiting, kHeavyBytes},
                         {2, kHeavyWaiting, kUnlimited},
                         {2, kUnlimited, kUnlimited}};  // each open stream has at most one task
};

}  // namespace tribodyn::server
