#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "google/rpc/status.pb.h"

namespace tribodyn::server {

/// A server stream that a client may hold open for long.
class LiveStream {
 public:
  virtual ~LiveStream() = default;
  /// Ends the stream soon: see StreamMachine::shut_down().
  virtual void shut_down(const google::rpc::Status& status) = 0;
};

/// The open streams of a transport: limits their number, and ends them when the server stops
/// (grpc::Server::Shutdown never returns while one callback RPC is unfinished). Safe for concurrent
/// access without external synchronization.
class LiveStreams {
 public:
  /// At most so many in all, and so many of one peer.
  explicit LiveStreams(std::size_t maximum,
                       std::size_t maximum_of_peer = std::numeric_limits<std::size_t>::max())
      : maximum_(maximum), maximum_of_peer_(maximum_of_peer) {}

  /// Returns nullopt, or why no further stream of the peer may open.
  std::optional<google::rpc::Status> add(const std::shared_ptr<LiveStream>& stream,
                                         const std::string& peer = {});
  void remove(const LiveStream* stream);
  /// Ends all soon, and lets none open any more.
  void shut_down();

 private:
  struct Entry {
    std::shared_ptr<LiveStream> stream;
    std::string peer;
  };
  const std::size_t maximum_;
  const std::size_t maximum_of_peer_;
  std::mutex mutex_;
  std::map<const LiveStream*, Entry> streams_;   // guarded by mutex_
  std::map<std::string, std::size_t> of_peers_;  // guarded by mutex_
  bool closed_ = false;                          // guarded by mutex_
};

}  // namespace tribodyn::server
