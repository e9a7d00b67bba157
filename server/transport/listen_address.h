#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace tribodyn::server {

/// The server cannot listen at its address. what() is a sentence for the operator.
class ListenError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Address of a server: a numeric address with a port, or a Unix socket.
struct ListenAddress {
  std::string host;         ///< "127.0.0.1", "[::1]"; empty for a Unix socket
  int port = 0;             ///< 0: the system picks one
  std::string socket_path;  ///< empty for TCP
  bool is_unix() const { return !socket_path.empty(); }
  /// True for addresses that other machines may reach: there TLS is required.
  bool is_remote() const;
};

/// Parses "127.0.0.1:50651", "[::1]:0", "localhost:50651", "0.0.0.0:50651" or
/// "unix:/run/tribodyn.sock". Throws ListenError for other forms.
ListenAddress parse_listen_address(const std::string& text);

/// Parses addresses with commas between them. Throws ListenError as parse_listen_address() does,
/// and for an address that stands twice.
std::vector<ListenAddress> parse_listen_addresses(const std::string& text);

/// Returns the addresses of a server that is told none: a Unix socket in a folder of the owner's,
/// $XDG_RUNTIME_DIR/tribodyn or else $HOME/.tribodyn, and port 50651 of loopback. Makes the folder,
/// for the owner only. There is no socket if neither variable is set.
/// Throws ListenError if the folder cannot be made or others may write to it.
std::vector<ListenAddress> default_addresses();

/// Returns the address in the form of gRPC and of clients.
std::string to_text(const ListenAddress& address);

}  // namespace tribodyn::server
