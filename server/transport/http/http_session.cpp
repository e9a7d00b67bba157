#include "server/transport/http/http_session.h"

#include <poll.h>
#include <sys/socket.h>

#include <boost/asio/write.hpp>
#include <cctype>
#include <ctime>
#include <limits>
#include <sstream>
#include <utility>

#include "server/application/errors.h"
#include "server/transport/http/rest_answer.h"

namespace tribodyn::server {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;

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

constexpr double kBusySeconds = 2;                   // until a body of usual length has been read
constexpr auto kFarewell = std::chrono::seconds(2);  // for a client to end TLS in turn
constexpr auto kHangupInterval = std::chrono::milliseconds(200);  // of looks at a busy connection
constexpr std::size_t kStrayBytes = 65'536;  // that a client may send while it reads a stream

}  // namespace

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

HttpServer::Connections::Session::Session(Connections& all, int connection, std::string its_peer)
    : peer(std::move(its_peer)),
      all_(all),
      connection_(byte_stream(all.context_, connection, all.tls_ ? all.tls_->current() : nullptr)),
      stream_(*connection_),
      timer_(all.context_) {}

void HttpServer::Connections::Session::start() {
  stream_.expires_after(all_.limits_.handshake_time);
  stream_.handshake([self = shared_from_this()](Error failure) {
    if (failure) return self->drop();
    self->certificate_ = self->stream_.client_certificate();
    self->read_head();
  });
}

void HttpServer::Connections::Session::close() {
  *cancelled_ = true;
  timer_.cancel();
  stream_.close();
}

void HttpServer::Connections::Session::write(HttpResponse response) {
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

bool HttpServer::Connections::Session::write_part(std::string part, bool is_last) {
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
  if (is_last) stream_.expires_after(all_.limits_.write_time);
  const std::array<asio::const_buffer, 3> buffers = {asio::buffer(frame_[0]), asio::buffer(part_),
                                                     asio::buffer(frame_[1])};
  asio::async_write(stream_, buffers,
                    [self = shared_from_this(), is_last](Error failure, std::size_t) {
                      self->part_written(failure, is_last);
                    });
  return true;
}

void HttpServer::Connections::Session::drop() {
  close();
  // A write that is under way fails now, and says so.
  if (const auto body = is_writing_ ? nullptr : std::exchange(body_stream_, nullptr)) {
    body->hang_up();
  }
  all_.remove(shared_from_this());
}

void HttpServer::Connections::Session::begin_stream(const HttpResponse& response) {
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
                      self->stream_.expires_never();  // the HttpStream limits the time of a part
                      self->drop_input();
                      self->start_body();
                    });
}

void HttpServer::Connections::Session::part_written(Error failure, bool is_last) {
  is_writing_ = false;
  const auto body = is_last || failure ? std::exchange(body_stream_, nullptr) : body_stream_;
  if (is_last || failure) end();
  if (!is_last && body != nullptr) body->written(!failure);
}

void HttpServer::Connections::Session::drop_input() {
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

void HttpServer::Connections::Session::read_head() {
  is_answering_ = false;
  head_.emplace();
  head_->header_limit(static_cast<std::uint32_t>(all_.limits_.head_bytes));
  head_->body_limit(std::numeric_limits<std::uint64_t>::max());  // limited by head_read()
  stream_.expires_after(all_.limits_.head_time);
  http::async_read_header(
      stream_, buffer_, *head_,
      [self = shared_from_this()](Error failure, std::size_t) { self->head_read(failure); });
}

void HttpServer::Connections::Session::head_read(Error failure) {
  if (failure == http::error::header_limit) {
    return refuse(431, "the head of the request is longer than " +
                           std::to_string(all_.limits_.head_bytes) + " bytes");
  }
  if (failure && failure.category() == http::make_error_code(http::error::bad_method).category() &&
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
    return refuse(
        413, "the body has " + std::to_string(length) + " bytes; allowed: " + std::to_string(most));
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

void HttpServer::Connections::Session::invite_body() {
  static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  stream_.expires_after(all_.limits_.write_time);
  asio::async_write(stream_, asio::buffer(kContinue.data(), kContinue.size()),
                    [self = shared_from_this()](Error failure, std::size_t) {
                      if (failure) return self->end();
                      self->read_body();
                    });
}

void HttpServer::Connections::Session::read_body() {
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

void HttpServer::Connections::Session::handle() {
  head_.reset();
  is_answering_ = true;
  stream_.expires_never();  // the dispatcher limits the time of a call
  is_head_ = request_.verb == "HEAD";
  watch_for_hangup();
  all_.handler_.handle(std::move(request_), cancelled_,
                       [all = all_.weak_from_this(), session = weak_from_this()](
                           HttpResponse response) { answer(all, session, std::move(response)); });
}

void HttpServer::Connections::Session::watch_for_hangup() {
  stream_.wait_for_input([self = shared_from_this(), answered = answered_](Error failure) {
    if (!failure) self->note_hangup(answered);
  });
}

void HttpServer::Connections::Session::note_hangup(unsigned answered) {
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

void HttpServer::Connections::Session::refuse(int status, const std::string& message) {
  refuse(http_error(status, message));
}

void HttpServer::Connections::Session::refuse(HttpResponse response) {
  is_kept_ = false;
  is_answering_ = true;
  head_.reset();
  response.headers.insert(security_headers().begin(), security_headers().end());
  write(std::move(response));
}

void HttpServer::Connections::Session::release_body() {
  all_.body_bytes_ -= counted_bytes_;
  counted_bytes_ = 0;
}

void HttpServer::Connections::Session::end() {
  stream_.expires_after(kFarewell);
  stream_.finish([self = shared_from_this()](Error) {
    self->close();
    self->all_.remove(self);
  });
}

void HttpServer::Connections::Session::start_body() {
  body_stream_->start(
      std::make_shared<Writer>(all_.weak_from_this(), shared_from_this(), body_stream_));
}

}  // namespace tribodyn::server
