#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// A request as it arrived, whatever carried it.
struct HttpRequest {
  std::string verb;                            ///< e.g. "GET"
  std::string target;                          ///< path and query, still percent-encoded
  std::map<std::string, std::string> headers;  ///< by name in lower case
  std::string body;
  std::string peer;       ///< address of the client
  bool is_owner = false;  ///< it came over a Unix socket that only the owner of the server reaches
  bool is_encrypted = false;     ///< it came by TLS
  std::string certificate = {};  ///< common name of the client's, which TLS has verified; or ""
  /// Hash of the token that the request's session stands for; empty: it has no valid session.
  std::string session_token_hash = {};

  /// Returns the value of a header, named in lower case, or "".
  std::string_view header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? std::string_view() : found->second;
  }
};

/// The connection that a streamed body is written to. Safe for concurrent access; each function
/// returns at once.
class HttpStreamWriter {
 public:
  virtual ~HttpStreamWriter() = default;
  /// Writes a part, and calls HttpStream::written() once at its end. The next part comes after
  /// that.
  virtual void write(std::string part) = 0;
  /// Writes the last part and ends the response well. The connection limits the time that this
  /// takes; the HttpStream limits that of the other parts, by cut_off().
  virtual void finish(std::string part) = 0;
  /// Breaks the response off, so that the client notices that the end is missing.
  virtual void cut_off() = 0;
};

/// A body that is made while it is sent. One thread calls at a time; no call may block.
class HttpStream {
 public:
  virtual ~HttpStream() = default;
  /// The head of the response is written. Called once, unless hang_up() comes first.
  virtual void start(std::shared_ptr<HttpStreamWriter> writer) = 0;
  /// A part is written; `ok` is false if the client has gone, and then no further part is.
  virtual void written(bool ok) = 0;
  /// The client has gone while no part was written. Parts that are written afterwards fail.
  virtual void hang_up() = 0;
};

struct HttpResponse {
  int status = 200;
  std::map<std::string, std::string> headers;  ///< by name as it is sent
  std::string body;
  std::shared_ptr<HttpStream> stream = nullptr;  ///< if set: makes the body
};

}  // namespace tribodyn::server
