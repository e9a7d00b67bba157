#pragma once

#include <functional>
#include <string>

#include "server/transport/acceptor.h"
#include "server/transport/listen_address.h"

namespace tribodyn::server {

/// Answers GET and HEAD /metrics over HTTP/1.0, one connection after the other. Closes a connection
/// after one second, or after 100 ms without a request. Its thread runs until the destructor.
class MetricsListener {
 public:
  /// `text` is called on the listener's thread. Throws ListenError.
  MetricsListener(const ListenAddress& address, std::function<std::string()> text);

  /// Returns the address with the actual port.
  const ListenAddress& address() const { return acceptor_.address(); }

 private:
  void answer(int connection) const;

  const std::function<std::string()> text_;
  Acceptor acceptor_;
};

}  // namespace tribodyn::server
