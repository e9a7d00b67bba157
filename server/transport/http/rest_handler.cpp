#include "server/transport/http/rest_handler.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "server/application/errors.h"
#include "server/application/guard.h"
#include "server/application/log_text.h"
#include "server/contract/resource_names.h"
#include "server/transport/http/media_types.h"
#include "server/transport/http/rest_answer.h"
#include "server/transport/http/rest_call.h"
#include "server/transport/http/rest_stream.h"
#include "server/transport/http/stream_format.h"

namespace tribodyn::server {
namespace {

constexpr std::size_t kLongestTarget = 8192;  // [bytes], as common servers and browsers allow

std::string_view path_of(const HttpRequest& request) {
  const std::string_view target = request.target;
  return target.substr(0, target.find('?'));
}

bool is_reading(const HttpRequest& request) {
  return request.verb == "GET" || request.verb == "HEAD";
}

/// "127.0.0.1" of "127.0.0.1:8080", "[::1]" of "[::1]:8080".
std::string_view host_of(std::string_view authority) {
  const std::size_t bracket = authority.rfind(']');
  const std::size_t colon = authority.rfind(':');
  const bool has_port =
      colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  return has_port ? authority.substr(0, colon) : authority;
}

HttpResponse foreign(const std::string& message) {
  return error_response(
      error(google::rpc::PERMISSION_DENIED, v1::ERROR_REASON_FOREIGN_ORIGIN, message));
}

/// Refuses what a page of another origin makes a browser send: this server answers whoever reaches
/// its address, and every page reaches loopback. Returns nullopt if the request is welcome.
std::optional<HttpResponse> foreign_origin(const HttpRequest& request) {
  const std::string_view authority = request.header("host");
  const std::string_view host = host_of(authority);
  if (host != "localhost" && host != "127.0.0.1" && host != "[::1]") {
    return foreign("this server is not called \"" + plain_excerpt(authority) +
                   "\"; address it as localhost, 127.0.0.1 or [::1]");
  }
  const std::string_view origin = request.header("origin");
  const bool is_own =
      origin == "http://" + std::string(authority) || origin == "https://" + std::string(authority);
  if ((!origin.empty() && !is_own) ||
      (!is_reading(request) && request.header("sec-fetch-site") == "cross-site")) {
    return foreign("pages of " + plain_excerpt(origin) + " may not call this server");
  }
  return std::nullopt;
}

bool is_json(std::string_view content_type) {
  content_type = content_type.substr(0, content_type.find(';'));
  while (content_type.ends_with(' ')) content_type.remove_suffix(1);
  return content_type == "application/json";
}

/// Returns the refusal of a body that is compressed or not JSON, or nullopt.
std::optional<HttpResponse> wrong_body(const HttpRequest& request) {
  if (request.body.empty()) return std::nullopt;
  const std::string_view encoding = request.header("content-encoding");
  const bool is_plain = encoding.empty() || encoding == "identity";
  if (is_plain && is_json(request.header("content-type"))) return std::nullopt;
  return http_error(
      415, is_plain ? "Content-Type is \"" + plain_excerpt(request.header("content-type")) +
                          "\"; allowed: application/json"
                    : "Content-Encoding is \"" + plain_excerpt(encoding) + "\"; allowed: none");
}

/// A unary call over HTTP; deletes itself once it has been answered.
class RestUnary final : public RestCall<UnaryCall> {
 public:
  RestUnary(RouteMatch its_route, HttpRequest its_request,
            std::shared_ptr<const std::atomic<bool>> cancelled, RestHandler::Reply reply,
            std::chrono::milliseconds limit)
      : RestCall(std::move(its_route), std::move(its_request), std::move(cancelled), limit),
        reply_(std::move(reply)) {}

  void answered(Outcome<Reply> outcome) override {
    const std::unique_ptr<RestUnary> self(this);
    reply_(response(outcome));
  }

 private:
  HttpResponse response(const Outcome<Reply>& outcome) const {
    try {
      if (!outcome.ok()) return error_response(outcome.error());
      return message_response(*outcome.message(), request, !written.has_read_mask);
    } catch (...) {
      return error_response(error_of_exception());
    }
  }

  const RestHandler::Reply reply_;
};

/// The forms in which a method answers, the usual one first.
std::vector<Form> forms_of(const Method& method) {
  if (method.answer) return {Form::kMessage};
  // Events have positions that a client resumes after; other messages are parts of one whole.
  if (resume_fields(*method.descriptor)) return {Form::kEvents, Form::kLines};
  return {Form::kLines};
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& each : words) out += (out.empty() ? "" : ", ") + each;
  return out;
}

}  // namespace

const std::map<std::string, std::string>& security_headers() {
  static const std::map<std::string, std::string> kHeaders = {
      {"Cache-Control", "private, no-cache"},  // kept, but asked for again with its ETag
      {"Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Referrer-Policy", "no-referrer"},
      {"X-Content-Type-Options", "nosniff"}};
  return kHeaders;
}

RestHandler::RestHandler(CallDispatcher& dispatcher, std::map<std::string, Page> pages,
                         const RestLimits& limits)
    : dispatcher_(dispatcher),
      routes_(dispatcher.methods()),
      pages_(std::move(pages)),
      streams_(limits.streams, limits.streams_of_peer) {}

std::size_t RestHandler::maximum_body_bytes(const HttpRequest& head) const {
  const auto route = routes_.find(head.verb, path_of(head));
  if (!route || route->body_field.empty()) return 0;
  return std::min(kMaximumBodyBytes,
                  kJsonGrowth * maximum_request_bytes(*route->method->descriptor));
}

void RestHandler::handle(HttpRequest request, std::shared_ptr<const std::atomic<bool>> cancelled,
                         Reply reply) {
  const auto answer = [reply = std::move(reply),
                       encoding =
                           std::string(request.header("accept-encoding"))](HttpResponse response) {
    response.headers.insert(security_headers().begin(), security_headers().end());
    if (response.stream == nullptr) compress(encoding, response);
    reply(std::move(response));
  };
  if (request.target.size() > kLongestTarget) {
    return answer(http_error(414, fmt::format("the target of the request has {} bytes; allowed: {}",
                                              request.target.size(), kLongestTarget)));
  }
  if (auto foreign = foreign_origin(request)) return answer(*std::move(foreign));
  const std::string path(path_of(request));
  if (const auto page = pages_.find(path); page != pages_.end() && is_reading(request)) {
    return answer(page->second());
  }
  const std::string verb = request.verb == "HEAD" ? "GET" : request.verb;
  auto route = routes_.find(verb, path);
  if (!route) {
    const std::vector<std::string> others = routes_.verbs(path);
    const std::string shown = plain_excerpt(path);
    const std::string shown_verb = plain_excerpt(request.verb);
    HttpResponse response = error_response(
        error(google::rpc::UNIMPLEMENTED, v1::ERROR_REASON_UNKNOWN_METHOD,
              others.empty() ? "no method has the path " + shown
                             : shown + " takes " + joined(others) + ", not " + shown_verb,
              {{"method", shown_verb + " " + shown}}),
        others.empty() ? 404 : 405);
    if (!others.empty()) response.headers["Allow"] = joined(others);
    return answer(std::move(response));
  }
  const Method& method = *route->method;
  if (method.open && request.verb == "HEAD") {
    HttpResponse response = http_error(405, method.descriptor->name() + " streams; send GET");
    response.headers["Allow"] = "GET";
    return answer(std::move(response));
  }
  if (auto wrong = wrong_body(request)) return answer(*std::move(wrong));
  HttpResponse unacceptable;
  const auto form = requested_form(request, forms_of(method), unacceptable);
  if (!form) return answer(std::move(unacceptable));
  if (method.open) {
    auto format =
        *form == Form::kEvents ? event_stream_format(*method.descriptor) : json_lines_format();
    return open_rest_stream(dispatcher_, streams_, *std::move(route), std::move(request),
                            std::move(cancelled), std::move(format), answer);
  }
  auto* call = new RestUnary(*std::move(route), std::move(request), std::move(cancelled), answer,
                             dispatcher_.limits().call);  // deletes itself
  dispatcher_.answer(*call);
}

}  // namespace tribodyn::server
