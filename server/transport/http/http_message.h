#pragma once

#include <map>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// A request as it arrived, whatever carried it.
struct HttpRequest {
  std::string verb;                            ///< e.g. "GET"
  std::string target;                          ///< path and query, still percent-encoded
  std::map<std::string, std::string> headers;  ///< by name in lower case
  std::string body;
  std::string peer;  ///< address of the client

  /// Returns the value of a header, named in lower case, or "".
  std::string_view header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? std::string_view() : found->second;
  }
};

struct HttpResponse {
  int status = 200;
  std::map<std::string, std::string> headers;  ///< by name as it is sent
  std::string body;
};

}  // namespace tribodyn::server
