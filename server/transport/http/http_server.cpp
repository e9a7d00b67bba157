#include "server/transport/http/http_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <iterator>
#include <utility>
#include <vector>

#include "server/transport/http/http_connections.h"
#include "server/transport/http/http_session.h"

namespace tribodyn::server {
namespace {

namespace asio = boost::asio;
using Error = boost::system::error_code;

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

constexpr auto kAnswersGrace = std::chrono::seconds(1);  // for answers under way
// Parts of streams, some 20 us each, that are written before a pause: 16,000 a second in all.
constexpr int kPartsAtOnce = 16;
constexpr auto kPartsPause = std::chrono::milliseconds(1);

}  // namespace

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
  handler_.shut_down_streams();
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
