#pragma once

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "server/application/application.h"

namespace tribodyn::server {

/// A connection of a client that writes its own HTTP.
class HttpConnection {
 public:
  /// The system buffers `buffer_bytes` of what the client has not read; 0: as many as it likes.
  explicit HttpConnection(int port, int buffer_bytes = 0)
      : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    if (buffer_bytes > 0) {
      setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof buffer_bytes);
    }
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_port = htons(static_cast<std::uint16_t>(port));
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  }
  ~HttpConnection() { hang_up(); }
  HttpConnection(HttpConnection&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;
  HttpConnection& operator=(HttpConnection&&) = delete;

  void hang_up() {
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
  }
  /// Returns false once the server has closed the connection.
  bool send(const std::string& text) {
    return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(text.size());
  }
  /// Sends a text of any length. Returns false once the server has closed the connection.
  bool send_all(std::string_view text) {
    while (!text.empty()) {
      const ssize_t count = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
      if (count <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }
  /// Reads until `end` has come, the server closes, or `limit` is over.
  std::string read_until(const std::string& end,
                         std::chrono::milliseconds limit = std::chrono::seconds(20)) {
    std::string out;
    using std::chrono::steady_clock;
    const auto last = steady_clock::now() + limit;
    while (out.find(end) == std::string::npos || end.empty()) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(last - steady_clock::now());
      pollfd ready{socket_, POLLIN, 0};
      if (left.count() <= 0 || poll(&ready, 1, static_cast<int>(left.count())) != 1) break;
      char part[65536];
      const ssize_t count = recv(socket_, part, sizeof part, 0);
      if (count <= 0) {
        is_closed_ = true;
        break;
      }
      out.append(part, static_cast<std::size_t>(count));
    }
    return out;
  }
  /// Reads what comes within `limit`.
  std::string read_some(std::chrono::milliseconds limit) {
    pollfd ready{socket_, POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(limit.count())) != 1) return {};
    std::string part(65536, '\0');
    const ssize_t count = recv(socket_, part.data(), part.size(), 0);
    is_closed_ = count <= 0;
    part.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return part;
  }
  /// All that comes until the server closes.
  std::string read_all() { return read_until(""); }
  bool is_closed() const { return is_closed_; }

 private:
  int socket_;
  bool is_closed_ = false;
};

inline constexpr char kSecret[] = "a-secret-of-the-owner";
/// Headers of every request: the server's name and the owner's token.
inline constexpr char kHost[] =
    "Host: localhost\r\nAuthorization: Bearer a-secret-of-the-owner\r\n";

/// Lets requests with kHost in.
inline void accept_owner(Application& application) {
  application.authorizer->set_tokens(
      {{.name = "owner", .hash = token_hash(kSecret), .scope = Scope::kAdmin}}, 0);
}

inline std::string get(const std::string& target, const std::string& headers = {}) {
  return "GET " + target + " HTTP/1.1\r\n" + kHost + headers + "\r\n";
}

}  // namespace tribodyn::server
