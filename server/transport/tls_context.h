#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "server/transport/tls_files.h"

struct ssl_ctx_st;
struct ssl_st;

namespace tribodyn::server {

/// The settings of TLS that a server gives its next connection: TLS 1.2 or later, ciphers with
/// forward secrecy, and, with client authorities, a certificate of every client. The files are read
/// again when they change; the former ones stay in use while the new ones are not usable, e.g.
/// between the two renames of a new key and its certificate. Not safe for concurrent access.
class TlsContext {
 public:
  /// Throws ListenError like require_usable.
  explicit TlsContext(TlsFiles files);

  /// Returns the settings for a connection that begins now.
  std::shared_ptr<ssl_ctx_st> current();

 private:
  using States = std::array<std::array<std::int64_t, 4>, 3>;  ///< what stat says of each file

  States states() const;

  const TlsFiles files_;
  States read_;  ///< of the files when they were read last
  std::shared_ptr<ssl_ctx_st> context_;
  std::chrono::steady_clock::time_point checked_;
};

/// Returns the common name of the certificate of the client at the other end; "" without one.
/// Requires that the handshake has verified the certificate.
std::string certificate_name(const ssl_st* connection);

}  // namespace tribodyn::server
