#pragma once

#include <string>

#include "server/transport/listen_address.h"

namespace tribodyn::server {

/// Files of a TLS server, in PEM form. All are read again when they change.
struct TlsFiles {
  std::string certificate;         ///< of the server, followed by those that sign it; empty: no TLS
  std::string key;                 ///< private key of the certificate
  std::string client_authorities;  ///< that sign clients' certificates; empty: clients need none
  bool is_set() const { return !certificate.empty(); }
};

/// Throws ListenError, which names the file, if a file cannot be read, the key is not that of the
/// certificate, or the certificate has expired.
void require_usable(const TlsFiles& files);

/// Throws ListenError, which says what to do, if other machines may reach the address and there is
/// no TLS.
void require_tls(const ListenAddress& address, const TlsFiles& tls);

}  // namespace tribodyn::server
