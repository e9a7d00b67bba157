#include "server/transport/listen_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <set>
#include <system_error>

#include "server/support/text.h"

namespace tribodyn::server {
namespace {

constexpr int kDefaultPort = 50651;
constexpr char kForms[] =
    "use 127.0.0.1:PORT, [::1]:PORT or unix:PATH, or with TLS 0.0.0.0:PORT or another address of "
    "this machine";

/// Returns the bytes of a numeric address; empty if the text is none.
std::string bytes_of(const std::string& host) {
  std::string out(sizeof(in6_addr), '\0');
  if (inet_pton(AF_INET, host.c_str(), out.data()) == 1) return out.substr(0, sizeof(in_addr));
  if (host.size() > 2 && host.front() == '[' && host.back() == ']' &&
      inet_pton(AF_INET6, host.substr(1, host.size() - 2).c_str(), out.data()) == 1) {
    return out;
  }
  return {};
}

bool is_loopback(const std::string& host) {
  const std::string bytes = bytes_of(host);
  if (bytes.size() == sizeof(in_addr)) return bytes.front() == 127;
  return bytes == std::string(sizeof(in6_addr) - 1, '\0') + '\1';
}

/// Makes a folder for the owner only. Throws ListenError if it cannot be made, or belongs to
/// another user, or another user may write to it.
void require_own_folder(const std::string& folder) {
  struct stat found {};
  const bool is_made = mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST;
  if (!is_made || lstat(folder.c_str(), &found) != 0) {
    throw ListenError("cannot make the folder " + folder + " for the socket: " +
                      std::generic_category().message(errno) + "; set --listen");
  }
  if (!S_ISDIR(found.st_mode) || found.st_uid != geteuid() || (found.st_mode & 077) != 0) {
    throw ListenError("the folder " + folder +
                      " for the socket is not the owner's alone; set its owner and chmod 700, or "
                      "set --listen");
  }
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
  out.port = parse_number<int>(text.substr(colon + 1)).value_or(-1);
  if (out.port < 0 || out.port > 65535) {
    throw ListenError("\"" + text + "\" does not end in a port from 0 to 65535; " + kForms);
  }
  if (out.host == "localhost") out.host = "127.0.0.1";
  if (bytes_of(out.host).empty()) {
    throw ListenError("refusing to listen on \"" + text +
                      "\": the host is not a numeric address; " + kForms);
  }
  return out;
}

bool ListenAddress::is_remote() const { return !is_unix() && !is_loopback(host); }

std::vector<ListenAddress> parse_listen_addresses(const std::string& text) {
  std::vector<ListenAddress> out;
  std::set<std::string> seen;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    out.push_back(parse_listen_address(text.substr(begin, end - begin)));
    const bool picks_port = !out.back().is_unix() && out.back().port == 0;
    if (!picks_port && !seen.insert(to_text(out.back())).second) {
      throw ListenError("\"" + text + "\" has " + to_text(out.back()) + " twice");
    }
    begin = end + 1;
  }
  return out;
}

std::vector<ListenAddress> default_addresses() {
  std::vector<ListenAddress> out;
  for (const auto& [variable, name] :
       {std::pair("XDG_RUNTIME_DIR", "/tribodyn"), std::pair("HOME", "/.tribodyn")}) {
    const char* parent = std::getenv(variable);
    if (parent == nullptr || *parent == '\0') continue;
    const std::string folder = std::string(parent) + name;
    require_own_folder(folder);
    out.push_back(parse_unix(folder + "/socket"));
    break;
  }
  out.push_back({.host = "127.0.0.1", .port = kDefaultPort, .socket_path = ""});
  return out;
}

std::string to_text(const ListenAddress& address) {
  if (address.is_unix()) return "unix:" + address.socket_path;
  return address.host + ":" + std::to_string(address.port);
}

}  // namespace tribodyn::server
