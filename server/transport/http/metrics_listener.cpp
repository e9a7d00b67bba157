#include "server/transport/http/metrics_listener.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>

namespace tribodyn::server {
namespace {

using std::chrono::steady_clock;

constexpr auto kLimit = std::chrono::seconds(1);
/// Longest wait for the first byte of a request, which a scraper sends at once. A silent connection
/// delays all others for this time.
constexpr auto kSilenceLimit = std::chrono::milliseconds(100);
constexpr std::size_t kLongestRequest = 8192;

/// Returns false if the socket is not ready for `event` before `end`.
bool is_ready(int connection, short event, steady_clock::time_point end) {
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(end - steady_clock::now());
  pollfd ready{connection, event, 0};
  return left.count() > 0 && poll(&ready, 1, static_cast<int>(left.count())) == 1;
}

/// Returns the head of a request, or the part of it that arrived before `end`.
std::string read_head(int connection, steady_clock::time_point end) {
  std::string head;
  std::array<char, 1024> part{};
  if (!is_ready(connection, POLLIN, std::min(end, steady_clock::now() + kSilenceLimit)))
    return head;
  while (head.find("\r\n\r\n") == std::string::npos && head.size() < kLongestRequest &&
         is_ready(connection, POLLIN, end)) {
    const ssize_t count = recv(connection, part.data(), part.size(), 0);
    if (count <= 0) break;
    head.append(part.data(), static_cast<std::size_t>(count));
  }
  return head;
}

void write_all(int connection, std::string_view bytes, steady_clock::time_point end) {
  while (!bytes.empty() && is_ready(connection, POLLOUT, end)) {
    const ssize_t count = send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

}  // namespace

MetricsListener::MetricsListener(const ListenAddress& address, std::function<std::string()> text)
    : text_(std::move(text)), acceptor_(address) {
  acceptor_.start([this](int, int connection) {
    answer(connection);
    close(connection);
  });
}

void MetricsListener::answer(int connection) const {
  const steady_clock::time_point end = steady_clock::now() + kLimit;
  const std::string head = read_head(connection, end);
  if (head.empty()) return;
  const bool is_head = head.starts_with("HEAD ");
  const bool is_known = head.starts_with(is_head ? "HEAD /metrics " : "GET /metrics ");
  const std::string body = is_known ? text_() : "GET /metrics\n";
  write_all(connection,
            std::string("HTTP/1.0 ") + (is_known ? "200 OK" : "404 Not Found") +
                "\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8\r\nContent-Length: " +
                std::to_string(body.size()) + "\r\nConnection: close\r\n\r\n" +
                (is_head ? "" : body),
            end);
  shutdown(connection, SHUT_WR);
}

}  // namespace tribodyn::server
