#pragma once

#include <chrono>
#include <cstddef>
#include <memory>

#include "server/transport/http/rest_handler.h"
#include "server/transport/listen_address.h"
#include "server/transport/tls_files.h"

namespace tribodyn::server {

/// What one client, or all together, may take of the server.
struct HttpLimits {
  int connections = 2000;
  int connections_of_a_peer = 1500;  ///< by address
  std::size_t head_bytes = 16 << 10;
  std::size_t bodies_bytes = 128 << 20;  ///< of all requests that are being read
  /// From a connection, or the answer before, until the head of a request is there.
  std::chrono::milliseconds head_time = std::chrono::seconds(30);
  std::chrono::milliseconds handshake_time = std::chrono::seconds(10);  ///< of TLS
  std::chrono::milliseconds body_time = std::chrono::seconds(60);
  std::chrono::milliseconds write_time = std::chrono::seconds(60);
};

/// Carries requests and responses of a RestHandler over HTTP/1.1. One thread reads and writes; the
/// handler's work runs elsewhere. Safe against clients that are slow, silent or hostile: each state
/// of a connection has a time limit, and nothing is allocated before it is counted.
class HttpServer {
 public:
  /// Listens at once, with TLS at an address that other machines reach. `handler` must outlive the
  /// object. Throws ListenError, also if such an address comes without `tls`.
  HttpServer(RestHandler& handler, const ListenAddress& address, const HttpLimits& limits = {},
             const TlsFiles& tls = {});
  /// Ends the handler's streams, lets calls under way be answered within a second, and closes all
  /// connections.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Returns the address with the port that the system picked.
  const ListenAddress& address() const;
  bool is_encrypted() const;

 private:
  class Connections;
  const std::shared_ptr<Connections> connections_;
};

}  // namespace tribodyn::server
