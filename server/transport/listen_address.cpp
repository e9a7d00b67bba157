#include "server/transport/listen_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/un.h>

#include <charconv>

namespace tribodyn::server {
namespace {

constexpr char kForms[] = "use 127.0.0.1:PORT, [::1]:PORT or unix:PATH";

bool is_loopback(const std::string& host) {
  in_addr v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24) == 127;
  in6_addr v6{};
  if (host.size() > 2 && host.front() == '[' && host.back() == ']' &&
      inet_pton(AF_INET6, host.substr(1, host.size() - 2).c_str(), &v6) == 1) {
    return IN6_IS_ADDR_LOOPBACK(&v6) != 0;
  }
  return false;
}

ListenAddress parse_unix(const std::string& path) {
  if (path.empty() || path.size() >= sizeof(sockaddr_un::sun_path)) {
    throw ListenError("unix:" + path + " is not a usable socket path (allowed: 1 to " +
                      std::to_string(sizeof(sockaddr_un::sun_path) - 1) + " bytes)");
  }
  return {.host = "", .port = 0, .socket_path = path};
}

}  // namespace

ListenAddress parse_listen_address(const std::string& text) {
  if (text.starts_with("unix:")) return parse_unix(text.substr(5));
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || (text.front() == '[' && text.find("]:") == std::string::npos)) {
    throw ListenError("\"" + text + "\" has no port; " + kForms);
  }
  ListenAddress out;
  out.host = text.substr(0, colon);
  const char* begin = text.data() + colon + 1;
  const char* end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(begin, end, out.port);
  if (error != std::errc() || parsed != end || out.port < 0 || out.port > 65535) {
    throw ListenError("\"" + text + "\" does not end in a port from 0 to 65535; " + kForms);
  }
  if (out.host == "localhost") out.host = "127.0.0.1";
  if (!is_loopback(out.host)) {
    throw ListenError("refusing to listen on \"" + text +
                      "\": tribodynd has no TLS and no authentication yet, so it only serves "
                      "this machine; " +
                      kForms);
  }
  return out;
}

std::string to_text(const ListenAddress& address) {
  if (address.is_unix()) return "unix:" + address.socket_path;
  return address.host + ":" + std::to_string(address.port);
}

}  // namespace tribodyn::server
