#pragma once

#include <stdexcept>
#include <string>

namespace tribodyn::server {

/// The server cannot listen where it was told to; what() is a sentence for the person who runs it.
class ListenError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Where to listen: a loopback address with a port, or a Unix socket.
struct ListenAddress {
  std::string host;         ///< "127.0.0.1", "[::1]"; empty for a Unix socket
  int port = 0;             ///< 0: the system picks one
  std::string socket_path;  ///< empty for TCP
  bool is_unix() const { return !socket_path.empty(); }
};

/// "127.0.0.1:50651", "[::1]:0", "localhost:50651", "unix:/run/tribodyn.sock". Throws ListenError
/// for anything else, and for every address that is not loopback: there is no TLS yet.
ListenAddress parse_listen_address(const std::string& text);

/// As gRPC and a client write it.
std::string to_text(const ListenAddress& address);

}  // namespace tribodyn::server
