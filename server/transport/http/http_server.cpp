#include "server/transport/http/http_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <cctype>
#include <ctime>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>  // Asio's headers need it and do not include it

#include "server/application/errors.h"
#include "server/transport/acceptor.h"
#include "server/transport/http/rest_answer.h"

namespace tribodyn::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using Protocol = asio::generic::stream_protocol;
using Stream = beast::basic_stream<Protocol, asio::io_context::executor_type>;
using Error = beast::error_code;

/// The numeric address of the client; "unix" for a Unix socket.
std::string peer_of(int connection) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getpeername(connection, reinterpret_cast<sockaddr*>(&address), &size) != 0) return "unknown";
  std::string text(INET6_ADDRSTRLEN, '\0');
  const void* number = nullptr;
  if (address.ss_family == AF_INET) {
    number = &reinterpret_cast<const sockaddr_in&>(address).sin_addr;
  } else if (address.ss_family == AF_INET6) {
    number = &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
  } else {
    return "unix";
  }
  inet_ntop(address.ss_family, number, text.data(), INET6_ADDRSTRLEN);
  return text.c_str();
}

int family_of(int connection) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  getsockname(connection, reinterpret_cast<sockaddr*>(&address), &size);
  return address.ss_family;
}

/// The time of day as the header Date has it.
std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::string text(40, '\0');
  text.resize(std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &parts));
  return text;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& each : out) each = static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
  return out;
}

constexpr double kBusySeconds = 2;  // until a body of usual length has been read

}  // namespace

/// All connections of a server. Runs on its one thread but for accept(), answer() and stop(). A
/// call that is answered after the server has stopped may hold the last reference.
class HttpServer::Connections : public std::enable_shared_from_this<Connections> {
 public:
  Connections(RestHandler& handler, const ListenAddress& address, const HttpLimits& limits);

  void start();
  void stop();

  const ListenAddress& address() const { return acceptor_.address(); }

 private:
  class Session;

  void add(int connection);
  static void answer(const std::weak_ptr<Connections>& all, const std::weak_ptr<Session>& session,
                     HttpResponse response);
  void remove(const std::shared_ptr<Session>& session);

  RestHandler& handler_;
  const HttpLimits limits_;
  std::set<std::shared_ptr<Session>> sessions_;
  std::map<std::string, int> of_peer_;
  std::size_t body_bytes_ = 0;  // of all requests that are being read or answered
  // Its destructor destroys the handlers that wait, and with them the last sessions: below all that
  // a session uses.
  asio::io_context context_{1};
  asio::executor_work_guard<asio::io_context::executor_type> work_{context_.get_executor()};
  Acceptor acceptor_;
  std::thread thread_;
};

/// A connection: reads a head, a body, has the request answered, writes the response, and begins
/// again.
class HttpServer::Connections::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(Connections& all, int connection, std::string its_peer)
      : peer(std::move(its_peer)), all_(all), stream_(all.context_) {
    const int on = 1;
    setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);  // fails for a Unix socket
    stream_.socket().assign(Protocol(family_of(connection), 0), connection);
  }
  ~Session() { release_body(); }

  void start() { read_head(); }

  void close() {
    *cancelled_ = true;
    Error ignored;
    stream_.socket().shutdown(asio::socket_base::shutdown_both, ignored);
    stream_.socket().close(ignored);
  }

  /// Sends the answer of the request.
  void write(HttpResponse response) {
    ++answered_;
    release_body();
    response_.emplace();
    response_->version(version_);
    response_->result(static_cast<unsigned>(response.status));
    for (const auto& [name, value] : response.headers) response_->set(name, value);
    response_->set(http::field::date, date_now());
    response_->keep_alive(is_kept_);
    if (response.status != 304) response_->content_length(response.body.size());
    if (!is_head_) response_->body() = std::move(response.body);
    stream_.expires_after(all_.limits_.write_time);
    http::async_write(stream_, *response_, [self = shared_from_this()](Error failure, std::size_t) {
      self->response_.reset();
      if (failure || !self->is_kept_) return self->end();
      self->read_head();
    });
  }

  const std::string peer;

 private:
  void read_head() {
    head_.emplace();
    head_->header_limit(static_cast<std::uint32_t>(all_.limits_.head_bytes));
    head_->body_limit(std::numeric_limits<std::uint64_t>::max());  // limited by head_read()
    stream_.expires_after(all_.limits_.head_time);
    http::async_read_header(
        stream_, buffer_, *head_,
        [self = shared_from_this()](Error failure, std::size_t) { self->head_read(failure); });
  }

  void head_read(Error failure) {
    if (failure == http::error::header_limit) {
      return refuse(431, "the head of the request is longer than " +
                             std::to_string(all_.limits_.head_bytes) + " bytes");
    }
    if (failure &&
        failure.category() == http::make_error_code(http::error::bad_method).category() &&
        failure != http::error::end_of_stream && failure != http::error::partial_message) {
      return refuse(400, "this is no HTTP: " + failure.message());
    }
    if (failure) return end();
    const auto& message = head_->get();
    request_ = {};
    request_.verb = std::string(message.method_string());
    request_.target = std::string(message.target());
    request_.peer = peer;
    for (const auto& field : message) {
      const auto [place, is_new] = request_.headers.emplace(
          lower_case({field.name_string().data(), field.name_string().size()}),
          std::string(field.value()));
      if (!is_new && place->first == "host") return refuse(400, "the header Host stands twice");
      if (!is_new) place->second += ", " + std::string(field.value());
    }
    is_kept_ = message.keep_alive();
    version_ = message.version();
    if (request_.headers.contains("transfer-encoding")) {
      return refuse(411, "a request needs Content-Length; it may not be sent in chunks");
    }
    const std::uint64_t length = head_->content_length().value_or(0);
    if (length == 0) return handle();
    const std::size_t most = all_.handler_.maximum_body_bytes(request_);
    if (length > most) {
      return refuse(413, "the body has " + std::to_string(length) +
                             " bytes; allowed: " + std::to_string(most));
    }
    if (all_.body_bytes_ + length > all_.limits_.bodies_bytes) {
      return refuse(error_response(exhausted(
          v1::ERROR_REASON_TOO_MANY_LARGE_REQUESTS,
          "other large requests are being read; try again in a few seconds", kBusySeconds)));
    }
    counted_bytes_ = length;
    all_.body_bytes_ += length;
    if (lower_case(request_.header("expect")) == "100-continue") return invite_body();
    read_body();
  }

  /// Tells a client that waits for it before it sends a long body.
  void invite_body() {
    static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    stream_.expires_after(all_.limits_.write_time);
    asio::async_write(stream_, asio::buffer(kContinue.data(), kContinue.size()),
                      [self = shared_from_this()](Error failure, std::size_t) {
                        if (failure) return self->end();
                        self->read_body();
                      });
  }

  void read_body() {
    body_.emplace(std::move(*head_));
    body_->body_limit(counted_bytes_);
    stream_.expires_after(all_.limits_.body_time);
    http::async_read(stream_, buffer_, *body_,
                     [self = shared_from_this()](Error failure, std::size_t) {
                       if (failure) return self->end();
                       self->request_.body = std::move(self->body_->get().body());
                       self->body_.reset();
                       self->handle();
                     });
  }

  void handle() {
    head_.reset();
    stream_.expires_never();  // the dispatcher limits the time of a call
    is_head_ = request_.verb == "HEAD";
    watch_for_hangup();
    all_.handler_.handle(std::move(request_), cancelled_,
                         [all = all_.weak_from_this(), session = weak_from_this()](
                             HttpResponse response) { answer(all, session, std::move(response)); });
  }

  /// Cancels the call if the client goes while it waits for the answer.
  void watch_for_hangup() {
    stream_.socket().async_wait(
        asio::socket_base::wait_read,
        [self = shared_from_this(), answered = answered_](Error failure) {
          if (failure || self->answered_ != answered) return;
          char byte = 0;
          const ssize_t count =
              recv(self->stream_.socket().native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
          if (count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK)) {
            *self->cancelled_ = true;
          }
        });
  }

  void refuse(int status, const std::string& message) { refuse(http_error(status, message)); }
  void refuse(HttpResponse response) {
    is_kept_ = false;
    head_.reset();
    response.headers.insert(security_headers().begin(), security_headers().end());
    write(std::move(response));
  }

  void release_body() {
    all_.body_bytes_ -= counted_bytes_;
    counted_bytes_ = 0;
  }

  void end() {
    // The client may still send what nobody reads; with these bytes unread a close would reset the
    // connection, and the client might lose the answer.
    Error ignored;
    stream_.socket().shutdown(asio::socket_base::shutdown_send, ignored);
    close();
    all_.remove(shared_from_this());
  }

  Connections& all_;
  Stream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> head_;
  std::optional<http::request_parser<http::string_body>> body_;
  std::optional<http::response<http::string_body>> response_;
  HttpRequest request_;
  const std::shared_ptr<std::atomic<bool>> cancelled_ = std::make_shared<std::atomic<bool>>(false);
  std::size_t counted_bytes_ = 0;
  unsigned version_ = 11;
  unsigned answered_ = 0;
  bool is_kept_ = false;
  bool is_head_ = false;
};

HttpServer::Connections::Connections(RestHandler& handler, const ListenAddress& address,
                                     const HttpLimits& limits)
    : handler_(handler), limits_(limits), acceptor_(address) {}

void HttpServer::Connections::start() {
  thread_ = std::thread([this] {
    for (;;) {
      try {
        context_.run();
        return;
      } catch (const std::exception& failure) {  // no memory for a connection: the others go on
        spdlog::error("event=http_failed cause=\"{}\"", failure.what());
      }
    }
  });
  acceptor_.start([this](int, int connection) {
    asio::post(context_, [this, connection] { add(connection); });
  });
}

void HttpServer::Connections::stop() {
  acceptor_.stop();
  asio::post(context_, [this] {
    for (const auto& session : sessions_) session->close();
    sessions_.clear();
    work_.reset();
  });
  thread_.join();
}

void HttpServer::Connections::answer(const std::weak_ptr<Connections>& all,
                                     const std::weak_ptr<Session>& session, HttpResponse response) {
  const auto connections = all.lock();
  if (!connections) return;
  asio::post(connections->context_, [session, response = std::move(response)]() mutable {
    if (const auto waiting = session.lock()) waiting->write(std::move(response));
  });
}

void HttpServer::Connections::add(int connection) try {
  std::string peer = peer_of(connection);
  if (static_cast<int>(sessions_.size()) >= limits_.connections ||
      of_peer_[peer] >= limits_.connections_of_a_peer) {
    ::close(connection);
    return;
  }
  const auto session = std::make_shared<Session>(*this, connection, std::move(peer));
  sessions_.insert(session);
  ++of_peer_[session->peer];
  session->start();
} catch (const std::exception& failure) {
  spdlog::warn("event=http_connection_refused cause=\"{}\"", failure.what());
}

void HttpServer::Connections::remove(const std::shared_ptr<Session>& session) {
  if (sessions_.erase(session) == 0) return;
  const auto found = of_peer_.find(session->peer);
  if (--found->second == 0) of_peer_.erase(found);
}

HttpServer::HttpServer(RestHandler& handler, const ListenAddress& address, const HttpLimits& limits)
    : connections_(std::make_shared<Connections>(handler, address, limits)) {
  connections_->start();
}

HttpServer::~HttpServer() { connections_->stop(); }

const ListenAddress& HttpServer::address() const { return connections_->address(); }

}  // namespace tribodyn::server
