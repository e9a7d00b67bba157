#pragma once

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>  // Asio's headers need it and do not include it

#include "server/transport/acceptor.h"
#include "server/transport/http/http_server.h"
#include "server/transport/tls_context.h"

namespace tribodyn::server {

/// All connections of a server. Runs on its one thread but for post(), answer() and stop(). A
/// call that is answered after the server has stopped may hold the last reference.
class HttpServer::Connections : public std::enable_shared_from_this<Connections> {
 public:
  Connections(RestHandler& handler, const ListenAddress& address, const HttpLimits& limits,
              const TlsFiles& tls);

  void start();
  void stop();

  const ListenAddress& address() const { return acceptor_.address(); }
  bool is_encrypted() const { return tls_.has_value(); }

 private:
  class Session;
  class Writer;

  /// Runs a task on the thread. Returns false, and does not run it, if the thread has ended.
  bool post(std::function<void()> task);
  /// The same, after earlier tasks of this kind, a few of which run at a time, then a pause: other
  /// requests do not wait for an event that a thousand streams send.
  bool post_part(std::function<void()> task);
  void run_parts();
  void begin_stop();
  void end_stop();
  void add(int connection);
  static void answer(const std::weak_ptr<Connections>& all, const std::weak_ptr<Session>& session,
                     HttpResponse response);
  void remove(const std::shared_ptr<Session>& session);

  RestHandler& handler_;
  const HttpLimits limits_;
  std::optional<TlsContext> tls_;
  std::set<std::shared_ptr<Session>> sessions_;
  std::map<std::string, int> of_peer_;
  std::size_t body_bytes_ = 0;  // of all requests that are being read or answered
  bool is_stopping_ = false;
  std::mutex posting_;
  bool is_closed_ = false;                   // guarded by posting_: nothing is posted any more
  std::deque<std::function<void()>> parts_;  // guarded by posting_; run_parts() is due if not empty
  // Its destructor destroys the handlers that wait, and with them the last sessions: below all that
  // a session uses.
  boost::asio::io_context context_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{
      context_.get_executor()};
  boost::asio::steady_timer grace_{context_};
  boost::asio::steady_timer pause_{context_};  // between parts
  Acceptor acceptor_;
  std::thread thread_;
};

}  // namespace tribodyn::server
