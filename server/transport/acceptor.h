#pragma once

#include <functional>
#include <thread>

#include "server/transport/listen_address.h"

namespace tribodyn::server {

/// The listening socket, and a thread that accepts connections and hands them on. gRPC 1.51 has its
/// own, but once the process has run out of file descriptors that one never accepts again
/// (grpc/grpc issue 20418): anybody who opens enough connections would make the server deaf. This
/// one turns connections away beyond `maximum_connections` and while descriptors are scarce, and
/// keeps some for the database.
/// Made, started and stopped by one thread.
class Acceptor {
 public:
  /// Binds and listens. Throws ListenError when the address is in use or not permitted. A socket
  /// file that a killed server left behind is replaced.
  explicit Acceptor(const ListenAddress& address, int maximum_connections = kMaximumConnections);
  ~Acceptor();
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  /// The address with the port that the system picked.
  const ListenAddress& address() const { return address_; }

  /// Takes over a connected socket, on the acceptor's thread.
  using Take = std::function<void(int listener, int connection)>;
  void start(Take take);
  void stop();

 private:
  void run(const Take& take) const;

  /// Each costs gRPC about 5 kB before its first call.
  static constexpr int kMaximumConnections = 10'000;

  ListenAddress address_;
  const int maximum_connections_;
  int listener_ = -1;
  int wake_ = -1;  ///< becomes readable when the thread is to end
  std::thread thread_;
};

}  // namespace tribodyn::server
