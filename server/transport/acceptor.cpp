#include "server/transport/acceptor.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>

namespace tribodyn::server {
namespace {

constexpr int kBacklog = 512;
constexpr int kReservedDescriptors = 64;  // for the database and gRPC's own needs
constexpr auto kPause = std::chrono::milliseconds(100);

std::string reason() { return std::generic_category().message(errno); }

/// A socket address of any kind, in the form of bind and connect.
struct SocketName {
  sockaddr_storage storage{};
  socklen_t length = 0;
  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
};

SocketName socket_name(const ListenAddress& address) {
  SocketName out;
  if (address.is_unix()) {
    auto* name = reinterpret_cast<sockaddr_un*>(&out.storage);
    name->sun_family = AF_UNIX;
    std::memcpy(name->sun_path, address.socket_path.c_str(), address.socket_path.size() + 1);
    out.length = sizeof(sockaddr_un);
  } else if (address.host.front() == '[') {
    auto* name = reinterpret_cast<sockaddr_in6*>(&out.storage);
    name->sin6_family = AF_INET6;
    name->sin6_port = htons(static_cast<std::uint16_t>(address.port));
    inet_pton(AF_INET6, address.host.substr(1, address.host.size() - 2).c_str(), &name->sin6_addr);
    out.length = sizeof(sockaddr_in6);
  } else {
    auto* name = reinterpret_cast<sockaddr_in*>(&out.storage);
    name->sin_family = AF_INET;
    name->sin_port = htons(static_cast<std::uint16_t>(address.port));
    inet_pton(AF_INET, address.host.c_str(), &name->sin_addr);
    out.length = sizeof(sockaddr_in);
  }
  return out;
}

/// True if the process at the other end of a Unix socket belongs to the user of this process. The
/// system keeps that from the time of the connect.
bool is_of_this_user(int connection) {
  ucred peer{};
  socklen_t size = sizeof(peer);
  return getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 &&
         peer.uid == geteuid();
}

int open_socket(const SocketName& name) {
  return socket(name.storage.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

/// Removes the socket file of a killed server. Throws ListenError if the path belongs to another
/// file or to a server that answers.
void clear_socket_path(const std::string& path, SocketName name) {
  struct stat found {};
  if (lstat(path.c_str(), &found) != 0) return;
  if (!S_ISSOCK(found.st_mode)) throw ListenError(path + " exists and is not a socket");
  const int probe = open_socket(name);
  const bool answered = connect(probe, name.get(), name.length) == 0 || errno == EAGAIN;
  close(probe);
  if (answered) throw ListenError("unix:" + path + " is in use by another server");
  unlink(path.c_str());
}

int port_of(int listener) {
  SocketName name;
  name.length = sizeof(name.storage);
  getsockname(listener, name.get(), &name.length);
  if (name.storage.ss_family == AF_INET6) {
    return ntohs(reinterpret_cast<const sockaddr_in6*>(&name.storage)->sin6_port);
  }
  return ntohs(reinterpret_cast<const sockaddr_in*>(&name.storage)->sin_port);
}

/// Returns the highest descriptor that a connection may have. The system assigns the lowest free
/// one, so a high one means that many are open.
int highest_descriptor(int maximum_connections) {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  const auto most = static_cast<int>(std::min<rlim_t>(limit.rlim_cur, 1 << 30));
  return std::min(std::max(most - kReservedDescriptors, most / 2),
                  maximum_connections + kReservedDescriptors);
}

}  // namespace

Acceptor::Acceptor(const ListenAddress& address, int maximum_connections)
    : address_(address), maximum_connections_(maximum_connections) {
  SocketName name = socket_name(address_);
  if (address_.is_unix()) clear_socket_path(address_.socket_path, name);
  listener_ = open_socket(name);
  const int yes = 1;
  // Takes a port in TIME_WAIT, but not one with a listener.
  setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  // Accepted connections inherit this option. Without it a short answer waits until the client has
  // acknowledged the previous one: until its next request, or up to 40 ms. Fails for a Unix socket.
  setsockopt(listener_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
  if (listener_ < 0 || bind(listener_, name.get(), name.length) != 0 ||
      listen(listener_, kBacklog) != 0) {
    const std::string why = reason();
    if (listener_ >= 0) close(listener_);
    throw ListenError("cannot listen on " + to_text(address_) + ": " + why);
  }
  if (!address_.is_unix()) address_.port = port_of(listener_);
  wake_ = eventfd(0, EFD_CLOEXEC);
}

Acceptor::~Acceptor() {
  stop();
  close(wake_);
}

void Acceptor::start(Take take) {
  thread_ = std::thread([this, take = std::move(take)] { run(take); });
}

void Acceptor::stop() {
  if (thread_.joinable()) {
    eventfd_write(wake_, 1);
    thread_.join();
  }
  if (listener_ < 0) return;
  close(listener_);
  listener_ = -1;
  if (address_.is_unix()) unlink(address_.socket_path.c_str());
}

void Acceptor::run(const Take& take) const {
  const int highest = highest_descriptor(maximum_connections_);
  bool scarce = false;
  for (;;) {
    pollfd events[] = {{listener_, POLLIN, 0}, {wake_, POLLIN, 0}};
    poll(events, 2, -1);
    if (events[1].revents != 0) return;
    const int connection = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    const bool none_left = connection < 0 && (errno == EMFILE || errno == ENFILE);
    if (connection >= 0 && address_.is_unix() && !is_of_this_user(connection)) {
      spdlog::warn("event=connection_refused address={} cause=\"another user\"", to_text(address_));
      close(connection);
    } else if (connection >= 0 && connection < highest) {
      scarce = false;
      take(listener_, connection);
    } else if (connection >= 0 || none_left) {
      if (!scarce) spdlog::warn("too many connections are open; new ones are closed");
      scarce = true;
      if (connection >= 0) close(connection);
      if (none_left) std::this_thread::sleep_for(kPause);
    }
  }
}

}  // namespace tribodyn::server
