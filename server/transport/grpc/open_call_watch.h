#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <unordered_set>

namespace tribodyn::server {

/// Closes TCP connections whose clients open more calls than they may. gRPC 1.51 keeps about 12 kB
/// for a call from its headers on, but shows the call to the server only once its request has
/// arrived, and its own limit of calls on a connection binds only a client that acknowledges it. A
/// thread of this class reads from gRPC's statistics (channelz) how many calls are open on each
/// connection. The calls of a connection that is closed end. Connections to a Unix socket stay:
/// only the owner's processes reach it.
class OpenCallWatch {
 public:
  /// Largest number of calls on one connection, and on all together. Beyond the latter the
  /// connections with most calls are closed.
  struct Limits {
    long connection;
    long all;
  };
  explicit OpenCallWatch(const Limits& limits);
  ~OpenCallWatch();
  OpenCallWatch(const OpenCallWatch&) = delete;
  OpenCallWatch& operator=(const OpenCallWatch&) = delete;

 private:
  void run();
  void look();

  const Limits limits_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_over_ = false;
  /// Connections that were closed and whose calls have not ended: their numbers in the statistics.
  std::unordered_set<std::intptr_t> closing_;
  std::thread thread_;
};

}  // namespace tribodyn::server
