#include "server/transport/grpc/open_call_watch.h"

#include <arpa/inet.h>
#include <grpc/grpc.h>
#include <grpc/support/alloc.h>
#include <netinet/in.h>
#include <openssl/evp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace tribodyn::server {
namespace {

using Statistics = nlohmann::json;
using std::chrono::steady_clock;

/// Pause between two looks. A client opens some thousand calls in it (measured).
constexpr auto kLookPause = std::chrono::milliseconds(500);
/// A look at thousands of connections takes longer, and its pause at least this many times as long.
constexpr int kLeastPauseOfLook = 20;
constexpr int kSocketsAtOnce = 500;  ///< connections listed at a time, the most that gRPC lists

/// The other end of a TCP connection, as the statistics write it.
struct Peer {
  std::string address;  ///< bytes of the IP address in base64
  int port = 0;
  bool operator==(const Peer&) const = default;
};

struct OpenConnection {
  std::intptr_t socket = 0;  ///< its number in the statistics, which no other connection has
  Peer peer;
  long calls = 0;
};

/// Returns what a function of channelz says; null without a text.
Statistics parsed(char* text) {
  const std::unique_ptr<char, void (*)(void*)> owned(text, gpr_free);
  return text == nullptr ? Statistics() : Statistics::parse(text, nullptr, false);
}

/// Returns a count. It is absent where it is 0, and a text otherwise.
long count_of(const Statistics& data, const char* name) {
  const auto found = data.find(name);
  return found == data.end() ? 0 : std::stol(found->get<std::string>());
}

/// Returns the connection of a socket's statistics; nullopt if it is not TCP or has ended.
std::optional<OpenConnection> connection_of(std::intptr_t socket) {
  const Statistics all = parsed(grpc_channelz_get_socket(socket));
  const Statistics::json_pointer remote("/socket/remote/tcpip_address"), data("/socket/data");
  if (!all.is_object() || !all.contains(remote) || !all.contains(data)) return std::nullopt;
  const Statistics& counts = all[data];
  return OpenConnection{socket,
                        {all[remote].value("ip_address", ""), all[remote].value("port", 0)},
                        count_of(counts, "streamsStarted") - count_of(counts, "streamsSucceeded") -
                            count_of(counts, "streamsFailed")};
}

/// Calls `add` for each element of the list `name` of all pages, with the number `number` of each.
void for_each_listed(const std::function<char*(std::intptr_t)>& page, const char* name,
                     const char* reference, const char* number,
                     const std::function<void(std::intptr_t)>& add) {
  for (std::intptr_t start = 0;;) {
    const Statistics listed = parsed(page(start));
    if (!listed.is_object() || !listed.contains(name)) return;
    for (const Statistics& each : listed[name]) {
      const Statistics& named = reference == nullptr ? each : each[reference];
      const auto id = static_cast<std::intptr_t>(std::stoll(named[number].get<std::string>()));
      add(id);
      start = id + 1;
    }
    if (listed.value("end", false)) return;
  }
}

/// Returns the TCP connections of all gRPC servers of this process.
std::vector<OpenConnection> tcp_connections() {
  std::vector<std::intptr_t> servers, sockets;
  for_each_listed(grpc_channelz_get_servers, "server", "ref", "serverId",
                  [&](std::intptr_t id) { servers.push_back(id); });
  for (const std::intptr_t server : servers) {
    for_each_listed(
        [server](std::intptr_t start) {
          return grpc_channelz_get_server_sockets(server, start, kSocketsAtOnce);
        },
        "socketRef", nullptr, "socketId", [&](std::intptr_t id) { sockets.push_back(id); });
  }
  std::vector<OpenConnection> out;
  for (const std::intptr_t socket : sockets) {
    if (auto connection = connection_of(socket)) out.push_back(std::move(*connection));
  }
  return out;
}

std::string base64(const void* bytes, int size) {
  std::string out(static_cast<std::size_t>(4 * ((size + 2) / 3) + 1), '\0');  // and a zero byte
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                                     static_cast<const unsigned char*>(bytes), size);
  out.resize(static_cast<std::size_t>(length));
  return out;
}

/// Returns the other end of a socket; nullopt if the descriptor is none of TCP.
std::optional<Peer> peer_of(int descriptor) {
  sockaddr_storage name{};
  socklen_t length = sizeof(name);
  if (getpeername(descriptor, reinterpret_cast<sockaddr*>(&name), &length) != 0) {
    return std::nullopt;
  }
  if (name.ss_family == AF_INET) {
    const auto& ip4 = reinterpret_cast<const sockaddr_in&>(name);
    return Peer{base64(&ip4.sin_addr, sizeof(ip4.sin_addr)), ntohs(ip4.sin_port)};
  }
  if (name.ss_family != AF_INET6) return std::nullopt;
  const auto& ip6 = reinterpret_cast<const sockaddr_in6&>(name);
  // gRPC writes an IPv4 address that is mapped to IPv6 as the former.
  const bool is_mapped = IN6_IS_ADDR_V4MAPPED(&ip6.sin6_addr);
  const unsigned char* const bytes = ip6.sin6_addr.s6_addr;
  return Peer{is_mapped ? base64(bytes + 12, 4) : base64(bytes, 16), ntohs(ip6.sin6_port)};
}

/// Shuts these connections down; gRPC then ends their calls and closes them. It keeps its
/// descriptors to itself, so that they are looked for among those of the process. Returns the
/// numbers, in the statistics, of those found.
std::unordered_set<std::intptr_t> shut_down(const std::vector<OpenConnection>& connections) {
  std::unordered_set<std::intptr_t> done;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int descriptor = std::stoi(entry.path().filename().string());
    const auto peer = peer_of(descriptor);
    if (!peer) continue;
    const auto found = std::find_if(connections.begin(), connections.end(),
                                    [&](const OpenConnection& each) { return each.peer == *peer; });
    if (found == connections.end()) continue;
    spdlog::warn("event=connection_closed port={} calls={} cause=\"too many open calls\"",
                 found->peer.port, found->calls);
    shutdown(descriptor, SHUT_RDWR);
    done.insert(found->socket);
  }
  return done;
}

}  // namespace

OpenCallWatch::OpenCallWatch(const Limits& limits) : limits_(limits), thread_([this] { run(); }) {}

OpenCallWatch::~OpenCallWatch() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void OpenCallWatch::run() {
  steady_clock::duration pause = kLookPause;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (changed_.wait_for(lock, pause, [this] { return is_over_; })) return;
    }
    const auto begin = steady_clock::now();
    try {
      look();
    } catch (const std::exception& defect) {
      spdlog::error("event=internal_error cause=\"open calls cannot be counted: {}\"",
                    defect.what());
    }
    pause = std::max<steady_clock::duration>(kLookPause,
                                             kLeastPauseOfLook * (steady_clock::now() - begin));
  }
}

/// Closes the connections that are beyond the limits. gRPC ends the calls of a closed connection
/// one after the other; a look that counted the rest of them would close a further connection.
void OpenCallWatch::look() {
  std::vector<OpenConnection> connections = tcp_connections();
  std::unordered_set<std::intptr_t> still_closing;
  std::erase_if(connections, [&](const OpenConnection& each) {
    if (!closing_.contains(each.socket)) return false;
    still_closing.insert(each.socket);
    return true;
  });
  std::sort(connections.begin(), connections.end(),
            [](const OpenConnection& one, const OpenConnection& other) {
              return one.calls > other.calls;
            });
  long open = 0;
  for (const OpenConnection& each : connections) open += each.calls;
  std::size_t closed = 0;
  for (; closed < connections.size(); ++closed) {
    const long calls = connections[closed].calls;
    if (calls <= limits_.connection && open <= limits_.all) break;
    open -= calls;
  }
  connections.resize(closed);
  closing_ = std::move(still_closing);
  if (!connections.empty()) closing_.merge(shut_down(connections));
}

}  // namespace tribodyn::server
