#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "google/rpc/status.pb.h"

namespace tribodyn::server {

/// A server stream that a client may hold open for long.
class LiveStream {
 public:
  virtual ~LiveStream() = default;
  /// Ends the stream soon: see StreamMachine::shut_down().
  virtual void shut_down(const google::rpc::Status& status) = 0;
  /// Enforces the time limits of the stream: see StreamMachine::look_at_clock(). Returns the time
  /// of the next call; nullopt: never.
  virtual std::optional<std::chrono::steady_clock::time_point> look_at_clock() = 0;
};

/// The open streams of a transport: limits their number, enforces their time limits, and ends them
/// when the server stops (grpc::Server::Shutdown never returns while one callback RPC is
/// unfinished). One thread enforces the limits of all: a timer for each stream would take half a
/// kilobyte. Safe for concurrent access. Must outlive the calls of its functions; shut_down() must
/// precede the destructor if a stream may be the last owner of the object.
class LiveStreams {
 public:
  using Clock = std::chrono::steady_clock;

  /// At most so many in all, and so many of one peer.
  explicit LiveStreams(std::size_t maximum,
                       std::size_t maximum_of_peer = std::numeric_limits<std::size_t>::max());
  ~LiveStreams();
  LiveStreams(const LiveStreams&) = delete;
  LiveStreams& operator=(const LiveStreams&) = delete;

  /// Returns nullopt, or why no further stream of the peer may open.
  std::optional<google::rpc::Status> add(const std::shared_ptr<LiveStream>& stream,
                                         const std::string& peer = {});
  void remove(const LiveStream* stream);
  /// From now on the thread of this object calls look_at_clock() of a stream that was added: first
  /// after kClockInterval, then at the time that look_at_clock() returned or up to kClockInterval
  /// later.
  void follow_clock(const LiveStream& stream);
  static constexpr auto kClockInterval = std::chrono::milliseconds(100);
  /// Ends all soon, lets none open any more, and ends the thread: time limits hold no longer.
  void shut_down();

 private:
  struct Entry {
    std::shared_ptr<LiveStream> stream;
    std::string peer;
    Clock::time_point next_look = Clock::time_point::max();
  };
  void run_clock();
  /// Calls look_at_clock() of a stream and stores the time of the next call.
  void look(LiveStream& stream);
  /// Returns the streams whose next call is due, and sets that call to one interval from `now`.
  /// Requires the lock.
  std::vector<std::shared_ptr<LiveStream>> take_due(Clock::time_point now);
  void set_next_look(const LiveStream& stream, Clock::time_point time);
  void end_clock();

  const std::size_t maximum_;
  const std::size_t maximum_of_peer_;
  std::mutex mutex_;
  std::map<const LiveStream*, Entry> streams_;   // guarded by mutex_
  std::map<std::string, std::size_t> of_peers_;  // guarded by mutex_
  // Guarded by mutex_; no stream's next look is earlier.
  Clock::time_point next_look_ = Clock::time_point::max();
  bool closed_ = false;  // guarded by mutex_
  std::condition_variable changed_;
  std::once_flag clock_ended_;
  std::thread clock_;  // last: it uses all of the above
};

}  // namespace tribodyn::server
