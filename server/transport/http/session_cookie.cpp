#include "server/transport/http/session_cookie.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "server/application/errors.h"
#include "server/storage/store_error.h"
#include "server/support/sha256.h"
#include "server/support/text.h"
#include "server/transport/http/rest_answer.h"
#include "server/transport/http/rest_call.h"

namespace tribodyn::server {
namespace {

constexpr std::size_t kHashDigits = 64;
constexpr std::size_t kLongestCookie = 200;  // [bytes]; one of this server has 146 at most

bool is_equal(std::string_view first, std::string_view second) {
  return first.size() == second.size() &&
         CRYPTO_memcmp(first.data(), second.data(), first.size()) == 0;
}

/// The name of the cookie. A browser sends cookies to every port of a host: servers on two ports
/// need two names.
std::string cookie_name(const HttpRequest& request) {
  const std::string_view host = request.header("host");
  const std::size_t colon = host.rfind(':');
  std::string out = "tribodyn-session";
  const std::size_t bracket = host.rfind(']');
  if (colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket)) {
    for (const char digit : host.substr(colon + 1)) {
      if (digit >= '0' && digit <= '9') out += digit;
    }
  }
  return out;
}

/// Returns the values of all cookies with a name.
std::vector<std::string> cookies(const HttpRequest& request, std::string_view name) {
  std::vector<std::string> out;
  std::string_view rest = request.header("cookie");
  while (!rest.empty()) {
    std::string_view pair = take_part(rest, ';');
    while (pair.starts_with(' ')) pair.remove_prefix(1);
    if (pair.size() <= name.size() || !pair.starts_with(name) || pair[name.size()] != '=') continue;
    out.emplace_back(pair.substr(name.size() + 1));
  }
  return out;
}

std::string set_cookie(const HttpRequest& request, const std::string& value) {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict{}{}", cookie_name(request), value,
                     request.is_encrypted ? "; Secure" : "", value.empty() ? "; Max-Age=0" : "");
}

HttpResponse refusal(const std::string& message) {
  return error_response(
      error(google::rpc::PERMISSION_DENIED, v1::ERROR_REASON_FOREIGN_ORIGIN, message));
}

std::string scope_text(Scope scope) {
  switch (scope) {
    case Scope::kRead:
      return "read";
    case Scope::kWrite:
      return "write";
    case Scope::kAdmin:
      break;
  }
  return "admin";
}

}  // namespace

SessionCookies::SessionCookies(std::shared_ptr<SessionFile> sessions, std::chrono::seconds lifetime)
    : sessions_(std::move(sessions)),
      lifetime_(std::chrono::duration_cast<std::chrono::microseconds>(lifetime).count()) {}

std::string SessionCookies::sealed(const std::string& text) const {
  return hmac_sha256(sessions_->key(), text);
}

std::string SessionCookies::issue(const std::string& token_hash, Microseconds now) const {
  const std::string text = token_hash + "." + std::to_string(now + lifetime_);
  return text + "." + sealed(text);
}

std::optional<SessionCookies::Session> SessionCookies::session_of(const std::string& cookie,
                                                                  Microseconds now) const {
  const std::size_t dot = cookie.rfind('.');
  if (cookie.size() > kLongestCookie || dot == std::string::npos || dot <= kHashDigits + 1) {
    return std::nullopt;
  }
  const std::string text = cookie.substr(0, dot);
  if (!is_equal(cookie.substr(dot + 1), sealed(text))) return std::nullopt;
  Microseconds end = 0;
  std::from_chars(text.data() + kHashDigits + 1, text.data() + text.size(), end);
  if (now >= end || end > now + lifetime_) return std::nullopt;
  if (sessions_->has_ended(sha256(cookie))) return std::nullopt;
  return Session{cookie, text.substr(0, kHashDigits), end};
}

std::optional<SessionCookies::Session> SessionCookies::session_of(const HttpRequest& request,
                                                                  Microseconds now) const {
  for (const std::string& each : cookies(request, cookie_name(request))) {
    if (auto session = session_of(each, now)) return session;
  }
  return std::nullopt;
}

std::string SessionCookies::csrf_token(const std::string& cookie) const {
  return sealed("csrf " + cookie);
}

HttpResponse SessionCookies::description(const Grant& grant, const std::string& cookie) const {
  HttpResponse out;
  out.headers["Content-Type"] = "application/json";
  out.headers["Cache-Control"] = "no-store";
  std::string projects;  // ids: letters, digits and '-'
  for (const std::string& each : grant.projects) {
    projects += (projects.empty() ? "\"" : ",\"") + each + '"';
  }
  out.body = fmt::format(
      "{{\"principal\":\"{}\",\"scope\":\"{}\",\"projects\":[{}],\"csrf_token\":\"{}\"}}\n",
      grant.principal, scope_text(grant.scope), projects,
      cookie.empty() ? std::string() : csrf_token(cookie));
  return out;
}

HttpResponse SessionCookies::answer(const Authorizer& authorizer, const HttpRequest& request,
                                    Microseconds now) const {
  if (request.verb == "DELETE") {
    if (const auto session = session_of(request, now)) {
      try {
        sessions_->end(sha256(session->cookie), session->end);
      } catch (const StoreError& failure) {
        spdlog::error("{}", failure.what());
        return error_response(store_failed(failure));
      }
    }
    HttpResponse out;
    out.status = 204;
    out.headers["Set-Cookie"] = set_cookie(request, "");
    out.headers["Clear-Site-Data"] = "\"cache\", \"storage\"";
    return out;
  }
  if (request.verb != "GET" && request.verb != "HEAD" && request.verb != "POST") {
    HttpResponse out = http_error(405, "a session takes GET, POST and DELETE");
    out.headers["Allow"] = "DELETE, GET, POST";
    return out;
  }
  const auto grant = authorizer.authenticate(credentials_of(request), now);
  if (!grant.ok()) return error_response(grant.error());
  if (request.verb != "POST") {
    const auto session = session_of(request, now);
    return description(*grant.message(), session ? session->cookie : std::string());
  }
  const auto hash = token_hash_of_bearer(request.header("authorization"));
  if (!hash) return error_response(unauthenticated("a session begins with a token"));
  const std::string cookie = issue(*hash, now);
  HttpResponse out = description(*grant.message(), cookie);
  out.headers["Set-Cookie"] = set_cookie(request, cookie);
  return out;
}

std::optional<HttpResponse> SessionCookies::admit(HttpRequest& request, Microseconds now) const {
  if (request.is_owner || !request.header("authorization").empty()) return std::nullopt;
  const auto session = session_of(request, now);
  if (!session) return std::nullopt;
  const std::string_view site = request.header("sec-fetch-site");
  if (!site.empty() && site != "same-origin" && site != "none") {
    return refusal("a page of another origin may not use the session of this one");
  }
  const bool is_reading = request.verb == "GET" || request.verb == "HEAD";
  if (!is_reading && !is_equal(request.header("tribodyn-csrf"), csrf_token(session->cookie))) {
    return refusal(
        "a change within a session needs the header Tribodyn-Csrf with the csrf_token of "
        "GET /session");
  }
  request.session_token_hash = session->token_hash;
  return std::nullopt;
}

}  // namespace tribodyn::server
