#pragma once

#include <functional>
#include <string>

#include "server/transport/acceptor.h"
#include "server/transport/listen_address.h"

namespace tribodyn::server {

/// Answers GET and HEAD /metrics over HTTP/1.0, one connection after the other, each within a
/// second, and closes one that sends nothing within 100 ms: enough for a scraper. Its thread runs
/// until the destructor.
class MetricsListener {
 public:
  /// Throws ListenError. `text` is called on the thread.
  MetricsListener(const ListenAddress& address, std::function<std::string()> text);

  /// With the port that the system picked.
  const ListenAddress& address() const { return acceptor_.address(); }

 private:
  void answer(int connection) const;

  const std::function<std::string()> text_;
  Acceptor acceptor_;
};

}  // namespace tribodyn::server
