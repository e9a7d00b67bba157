#include "server/transport/http/http_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <cctype>
#include <ctime>
#include <deque>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>  // Asio's headers need it and do not include it

#include "server/application/errors.h"
#include "server/transport/acceptor.h"
#include "server/transport/http/byte_stream.h"
#include "server/transport/http/rest_answer.h"
#include "server/transport/tls_context.h"

namespace tribodyn::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
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
constexpr auto kAnswersGrace = std::chrono::seconds(1);           // for answers under way
constexpr auto kFarewell = std::chrono::seconds(2);               // for a client to end TLS in turn
constexpr auto kHangupInterval = std::chrono::milliseconds(200);  // of looks at a busy connection
// Parts of streams, some 20 us each, that are written before a pause: 16,000 a second in all.
constexpr int kPartsAtOnce = 16;
constexpr auto kPartsPause = std::chrono::milliseconds(1);
constexpr std::size_t kStrayBytes = 65'536;  // that a client may send while it reads a stream

}  // namespace

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
  asio::io_context context_{1};
  asio::executor_work_guard<asio::io_context::executor_type> work_{context_.get_executor()};
  asio::steady_timer grace_{context_};
  asio::steady_timer pause_{context_};  // between parts
  Acceptor acceptor_;
  std::thread thread_;
};

/// A connection: reads a head, a body, has the request answered, writes the response, and begins
/// again.
class HttpServer::Connections::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(Connections& all, int connection, std::string its_peer)
      : peer(std::move(its_peer)),
        all_(all),
        connection_(
            byte_stream(all.context_, connection, all.tls_ ? all.tls_->current() : nullptr)),
        stream_(*connection_),
        timer_(all.context_) {
    const int on = 1;
    setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);  // fails for a Unix socket
  }
  ~Session() { release_body(); }

  void start() {
    stream_.expires_after(all_.limits_.handshake_time);
    stream_.handshake([self = shared_from_this()](Error failure) {
      if (failure) return self->drop();
      self->certificate_ = self->stream_.client_certificate();
      self->read_head();
    });
  }

  void close() {
    *cancelled_ = true;
    timer_.cancel();
    stream_.close();
  }

  bool is_open() const { return stream_.descriptor() >= 0; }
  /// True from the end of a request to the end of its answer.
  bool is_answering() const { return is_answering_; }

  /// Sends the answer of the request.
  void write(HttpResponse response) {
    ++answered_;
    release_body();
    if (response.stream != nullptr) return begin_stream(response);
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
      if (failure || !self->is_kept_ || self->all_.is_stopping_) return self->end();
      self->read_head();
    });
  }

  /// Returns false if the client has gone meanwhile.
  bool write_part(std::string part, bool is_last) {
    if (body_stream_ == nullptr) return false;
    is_writing_ = true;
    part_ = std::move(part);
    frame_[0].clear();
    frame_[1].clear();
    if (is_chunked_) {
      if (!part_.empty()) {
        std::ostringstream size;
        size << std::hex << part_.size() << "\r\n";
        frame_[0] = size.str();
        frame_[1] = "\r\n";
      }
      if (is_last) frame_[1] += "0\r\n\r\n";
    }
    const std::array<asio::const_buffer, 3> buffers = {asio::buffer(frame_[0]), asio::buffer(part_),
                                                       asio::buffer(frame_[1])};
    asio::async_write(stream_, buffers,
                      [self = shared_from_this(), is_last](Error failure, std::size_t) {
                        self->part_written(failure, is_last);
                      });
    return true;
  }
  void wake_at(std::chrono::steady_clock::time_point time) {
    if (body_stream_ == nullptr) return;
    timer_.expires_at(time);
    timer_.async_wait([self = shared_from_this()](Error failure) {
      if (!failure && self->body_stream_ != nullptr) self->body_stream_->wake();
    });
  }
  /// Ends a connection whose client is gone or reads too slowly; one without a stream likewise.
  void drop() {
    close();
    // A write that is under way fails now, and says so.
    if (const auto body = is_writing_ ? nullptr : std::exchange(body_stream_, nullptr)) {
      body->hang_up();
    }
    all_.remove(shared_from_this());
  }

  const std::string peer;

 private:
  /// Writes the head of a response, then has its body made part by part.
  void begin_stream(const HttpResponse& response) {
    is_kept_ = false;
    body_stream_ = response.stream;
    http::response_header<> head;
    head.version(version_);
    head.result(static_cast<unsigned>(response.status));
    for (const auto& [name, value] : response.headers) head.set(name, value);
    head.set(http::field::date, date_now());
    head.set(http::field::connection, "close");
    is_chunked_ = version_ >= 11 && !response.headers.contains("Content-Length");
    if (is_chunked_) head.set(http::field::transfer_encoding, "chunked");
    std::ostringstream text;
    text << head;
    part_ = text.str();
    is_writing_ = true;
    stream_.expires_after(all_.limits_.write_time);
    asio::async_write(stream_, asio::buffer(part_),
                      [self = shared_from_this()](Error failure, std::size_t) {
                        self->is_writing_ = false;
                        if (failure) return self->drop();
                        self->stream_.expires_never();  // the stream limits the time of a part
                        self->drop_input();
                        self->start_body();
                      });
  }

  void start_body();

  void part_written(Error failure, bool is_last) {
    is_writing_ = false;
    const auto body = is_last || failure ? std::exchange(body_stream_, nullptr) : body_stream_;
    if (is_last || failure) end();
    if (!is_last && body != nullptr) body->written(!failure);
  }

  /// Reads and drops what a client sends while it receives a stream, to notice its hang-up.
  void drop_input() {
    stream_.wait_for_input([self = shared_from_this()](Error failure) {
      if (failure || self->body_stream_ == nullptr) return;
      char bytes[4096];
      const ssize_t count = recv(self->stream_.descriptor(), bytes, sizeof bytes, MSG_DONTWAIT);
      const bool has_none = count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
      if (count > 0) self->stray_bytes_ += static_cast<std::size_t>(count);
      if ((count <= 0 && !has_none) || self->stray_bytes_ > kStrayBytes) return self->drop();
      self->drop_input();
    });
  }

  void read_head() {
    is_answering_ = false;
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
    request_.is_owner = all_.address().is_unix();
    request_.is_encrypted = all_.tls_.has_value();
    request_.certificate = certificate_;
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
    if (auto refused = all_.handler_.refuse_head(request_)) {
      is_kept_ = false;
      head_.reset();
      return write(*std::move(refused));
    }
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
    is_answering_ = true;
    stream_.expires_never();  // the dispatcher limits the time of a call
    is_head_ = request_.verb == "HEAD";
    watch_for_hangup();
    all_.handler_.handle(std::move(request_), cancelled_,
                         [all = all_.weak_from_this(), session = weak_from_this()](
                             HttpResponse response) { answer(all, session, std::move(response)); });
  }

  /// Cancels the call if the client goes while it waits for the answer.
  void watch_for_hangup() {
    stream_.wait_for_input([self = shared_from_this(), answered = answered_](Error failure) {
      if (!failure) self->note_hangup(answered);
    });
  }

  /// Before its end a client may have sent the next request, or the end of TLS.
  void note_hangup(unsigned answered) {
    if (answered_ != answered || !is_open()) return;
    pollfd state{stream_.descriptor(), POLLRDHUP, 0};
    if (poll(&state, 1, 0) == 1) {
      *cancelled_ = true;
      return;
    }
    timer_.expires_after(kHangupInterval);
    timer_.async_wait([self = shared_from_this(), answered](Error failure) {
      if (!failure) self->note_hangup(answered);
    });
  }

  void refuse(int status, const std::string& message) { refuse(http_error(status, message)); }
  void refuse(HttpResponse response) {
    is_kept_ = false;
    is_answering_ = true;
    head_.reset();
    response.headers.insert(security_headers().begin(), security_headers().end());
    write(std::move(response));
  }

  void release_body() {
    all_.body_bytes_ -= counted_bytes_;
    counted_bytes_ = 0;
  }

  void end() {
    stream_.expires_after(kFarewell);
    stream_.finish([self = shared_from_this()](Error) {
      self->close();
      self->all_.remove(self);
    });
  }

  Connections& all_;
  const std::unique_ptr<ByteStream> connection_;
  ByteStream& stream_;        // *connection_, as Beast's functions take it
  asio::steady_timer timer_;  // of a streamed body, or for a hang-up while a call is under way
  std::string certificate_;   // common name of the client's
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
  bool is_answering_ = false;
  // Of a streamed body: null from its end on, or from the failure of a write.
  std::shared_ptr<HttpStream> body_stream_;
  std::string part_;
  std::array<std::string, 2> frame_;  // what HTTP puts around a part
  std::size_t stray_bytes_ = 0;
  bool is_chunked_ = false;
  bool is_writing_ = false;
};

/// Passes the parts of a body to the thread of the connections.
class HttpServer::Connections::Writer : public HttpStreamWriter {
 public:
  Writer(std::weak_ptr<Connections> all, const std::shared_ptr<Session>& session,
         const std::shared_ptr<HttpStream>& body)
      : all_(std::move(all)), session_(session), body_(body) {}

  void write(std::string part) override { send(std::move(part), false); }
  void finish(std::string part) override { send(std::move(part), true); }
  void cut_off() override {
    post([session = session_] {
      if (const auto open = session.lock()) open->drop();
    });
  }
  void wake_at(std::chrono::steady_clock::time_point time) override {
    post([session = session_, time] {
      if (const auto open = session.lock()) open->wake_at(time);
    });
  }

 private:
  bool post(std::function<void()> task) const {
    const auto all = all_.lock();
    return all != nullptr && all->post(std::move(task));
  }
  bool post_part(std::function<void()> task) const {
    const auto all = all_.lock();
    return all != nullptr && all->post_part(std::move(task));
  }
  void send(std::string part, bool is_last) const {
    const auto fail = [body = body_, is_last] {
      const auto waiting = is_last ? nullptr : body.lock();
      if (waiting != nullptr) waiting->written(false);
    };
    const bool is_posted =
        post_part([session = session_, part = std::move(part), is_last, fail]() mutable {
          const auto open = session.lock();
          if (open == nullptr || !open->write_part(std::move(part), is_last)) fail();
        });
    if (!is_posted) fail();
  }

  const std::weak_ptr<Connections> all_;
  const std::weak_ptr<Session> session_;
  const std::weak_ptr<HttpStream> body_;
};

void HttpServer::Connections::Session::start_body() {
  body_stream_->start(
      std::make_shared<Writer>(all_.weak_from_this(), shared_from_this(), body_stream_));
}

HttpServer::Connections::Connections(RestHandler& handler, const ListenAddress& address,
                                     const HttpLimits& limits, const TlsFiles& tls)
    : handler_(handler), limits_(limits), acceptor_(address) {
  require_tls(address, tls);
  if (address.is_remote()) tls_.emplace(tls);
}

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
  handler_.close_streams();
  post([this] { begin_stop(); });
  thread_.join();
}

bool HttpServer::Connections::post(std::function<void()> task) {
  const std::lock_guard lock(posting_);
  if (is_closed_) return false;
  asio::post(context_, std::move(task));
  return true;
}

bool HttpServer::Connections::post_part(std::function<void()> task) {
  const std::lock_guard lock(posting_);
  if (is_closed_) return false;
  parts_.push_back(std::move(task));
  if (parts_.size() == 1) asio::post(context_, [this] { run_parts(); });
  return true;
}

void HttpServer::Connections::run_parts() {
  std::vector<std::function<void()>> due;
  {
    const std::lock_guard lock(posting_);
    const auto end = parts_.begin() + std::min<std::ptrdiff_t>(std::ssize(parts_), kPartsAtOnce);
    due.assign(std::make_move_iterator(parts_.begin()), std::make_move_iterator(end));
    parts_.erase(parts_.begin(), end);
    if (!parts_.empty()) {
      pause_.expires_after(kPartsPause);
      pause_.async_wait([this](Error) { run_parts(); });
    }
  }
  for (const auto& each : due) {
    try {
      each();
    } catch (const std::exception& failure) {  // no memory for a part: the others go on
      spdlog::error("event=http_failed cause=\"{}\"", failure.what());
    }
  }
}

/// Ends connections without a request under way, and the others once they are answered.
void HttpServer::Connections::begin_stop() {
  is_stopping_ = true;
  for (const auto& session : std::set(sessions_)) {
    if (!session->is_answering()) session->drop();
  }
  if (sessions_.empty()) return end_stop();
  grace_.expires_after(kAnswersGrace);
  grace_.async_wait([this](Error failure) {
    if (!failure) end_stop();
  });
}

/// Ends what is left, and then the thread.
void HttpServer::Connections::end_stop() {
  {
    const std::lock_guard lock(posting_);
    if (std::exchange(is_closed_, true)) return;
  }
  for (const auto& session : std::set(sessions_)) session->drop();
  grace_.cancel();
  work_.reset();
}

void HttpServer::Connections::answer(const std::weak_ptr<Connections>& all,
                                     const std::weak_ptr<Session>& session, HttpResponse response) {
  const auto hang_up = [stream = response.stream] {
    if (stream != nullptr) stream->hang_up();
  };
  const auto connections = all.lock();
  const auto send = [session, response = std::move(response), hang_up]() mutable {
    const auto waiting = session.lock();
    if (waiting == nullptr || !waiting->is_open()) return hang_up();
    waiting->write(std::move(response));
  };
  if (connections == nullptr || !connections->post(send)) hang_up();
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
  if (is_stopping_ && sessions_.empty()) end_stop();
  const auto found = of_peer_.find(session->peer);
  if (--found->second == 0) of_peer_.erase(found);
}

HttpServer::HttpServer(RestHandler& handler, const ListenAddress& address, const HttpLimits& limits,
                       const TlsFiles& tls)
    : connections_(std::make_shared<Connections>(handler, address, limits, tls)) {
  connections_->start();
}

HttpServer::~HttpServer() { connections_->stop(); }

bool HttpServer::is_encrypted() const { return connections_->is_encrypted(); }

const ListenAddress& HttpServer::address() const { return connections_->address(); }

}  // namespace tribodyn::server
