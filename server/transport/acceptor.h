#pragma once

#include <functional>
#include <thread>

#include "server/transport/listen_address.h"

namespace tribodyn::server {

/// A listening socket, and a thread that accepts connections and passes them on. gRPC 1.51 has its
/// own acceptor, which stops for good once the process has run out of file descriptors (grpc/grpc
/// issue 20418), so that any client with enough connections could block all others. This class
/// closes new connections beyond `maximum_connections` and while descriptors are scarce, and
/// reserves some for the database. It closes connections of other users to a Unix socket, so that
/// every call over one is the owner's. One thread must construct, start and stop the object.
class Acceptor {
 public:
  /// Binds and listens. Replaces the socket file of a killed server. Throws ListenError if the
  /// address is in use or not permitted.
  explicit Acceptor(const ListenAddress& address, int maximum_connections = kMaximumConnections);
  ~Acceptor();
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  /// Returns the address with the actual port.
  const ListenAddress& address() const { return address_; }

  /// Called on the acceptor's thread; takes over the connected socket.
  using Take = std::function<void(int listener, int connection)>;
  void start(Take take);
  void stop();

 private:
  void run(const Take& take) const;

  /// gRPC keeps about 5 kB for each before its first call.
  static constexpr int kMaximumConnections = 10'000;

  ListenAddress address_;
  const int maximum_connections_;
  int listener_ = -1;
  int wake_ = -1;  ///< becomes readable when the thread must end
  std::thread thread_;
};

}  // namespace tribodyn::server
