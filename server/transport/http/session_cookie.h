#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/application/authorizer.h"
#include "server/storage/session_file.h"
#include "server/transport/http/http_message.h"

namespace tribodyn::server {

/// Sessions of browsers. A page sends a token once, and the server answers with a cookie that no
/// script can read and no other site can send. The cookie holds the hash of the token and the end
/// of the session under a seal: sessions outlive restarts of the server, and end with their token,
/// after their lifetime, at DELETE, and all of them when the key of the seal changes. A request
/// that changes something also needs the header `Tribodyn-Csrf`, which only a page of the same
/// origin can read: the cookie goes to every port of the host. Safe for concurrent access.
class SessionCookies {
 public:
  explicit SessionCookies(std::shared_ptr<SessionFile> sessions,
                          std::chrono::seconds lifetime = std::chrono::hours(12));

  /// The path of the session: POST with a token begins it, GET describes it, DELETE ends it.
  static constexpr std::string_view kPath = "/session";

  /// Answers a request for kPath. The description: {"principal", "scope", "projects",
  /// "csrf_token"}.
  HttpResponse answer(const Authorizer& authorizer, const HttpRequest& request,
                      Microseconds now) const;

  /// Sets `request.session_token_hash` if the request shows who makes it by a valid cookie alone.
  /// Returns the refusal of a request that another page may have made the browser send, else
  /// nullopt.
  std::optional<HttpResponse> admit(HttpRequest& request, Microseconds now) const;

 private:
  std::string issue(const std::string& token_hash, Microseconds now) const;
  /// What a valid cookie stands for.
  struct Session {
    std::string cookie;
    std::string token_hash;
    Microseconds end = 0;
  };
  /// Returns nullopt if the cookie is forged, expired or ended.
  std::optional<Session> session_of(const std::string& cookie, Microseconds now) const;
  /// Returns the session of the first valid cookie of a request. To be asked once for a request:
  /// the key may change at any moment.
  std::optional<Session> session_of(const HttpRequest& request, Microseconds now) const;
  std::string csrf_token(const std::string& cookie) const;
  HttpResponse description(const Grant& grant, const std::string& cookie) const;

  /// Returns the seal of a text: of a cookie, or of what goes with it.
  std::string sealed(const std::string& text) const;

  const std::shared_ptr<SessionFile> sessions_;
  const Microseconds lifetime_;
};

}  // namespace tribodyn::server
