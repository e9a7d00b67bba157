#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "google/rpc/status.pb.h"

namespace tribodyn::server {

/// A server stream that a client may hold open for long.
class LiveStream {
 public:
  virtual ~LiveStream() = default;
  /// Ends the stream as soon as no write is under way.
  virtual void close(const google::rpc::Status& status) = 0;
};

/// All open streams, so that a shutdown can finish them: grpc::Server::Shutdown never returns while
/// one callback RPC is unfinished. Safe for concurrent access without external synchronization.
class LiveStreams {
 public:
  explicit LiveStreams(std::size_t maximum) : maximum_(maximum) {}

  /// Nothing, or why no further stream may open.
  std::optional<google::rpc::Status> add(const std::shared_ptr<LiveStream>& stream);
  void remove(const LiveStream* stream);
  /// Closes all and lets none open any more.
  void close_all();

 private:
  const std::size_t maximum_;
  std::mutex mutex_;
  std::map<const LiveStream*, std::shared_ptr<LiveStream>> streams_;  // guarded by mutex_
  bool closed_ = false;                                               // guarded by mutex_
};

}  // namespace tribodyn::server
