#include "server/transport/http/rest_handler.h"

#include <fmt/format.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "server/application/errors.h"
#include "server/application/guard.h"
#include "server/application/log_text.h"
#include "server/contract/resource_names.h"
#include "server/transport/call_words.h"
#include "server/transport/http/rest_answer.h"
#include "server/transport/http/rest_request.h"

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
class RestCall final : public UnaryCall {
 public:
  RestCall(RouteMatch route, HttpRequest request,
           std::shared_ptr<const std::atomic<bool>> cancelled, RestHandler::Reply reply,
           std::chrono::milliseconds limit)
      : UnaryCall(*route.method),
        route_(std::move(route)),
        request_(std::move(request)),
        cancelled_(std::move(cancelled)),
        reply_(std::move(reply)) {
    context = call_context({.client = request_.header("tribodyn-client"),
                            .request_id = request_.header("tribodyn-request-id"),
                            .peer = request_.peer},
                           limit, *cancelled_);
  }

  std::size_t request_size() const override {
    return is_prepared_ ? written_.wire.size() : request_.body.size() + request_.target.size();
  }
  std::optional<google::rpc::Status> prepare() override {
    is_prepared_ = true;
    auto refused = write_request(route_, request_, written_);
    std::string().swap(request_.body);
    return refused;
  }
  std::unique_ptr<google::protobuf::io::ZeroCopyInputStream> read_request() override {
    return std::make_unique<google::protobuf::io::ArrayInputStream>(
        written_.wire.data(), static_cast<int>(written_.wire.size()));
  }
  void drop_request() override { std::string().swap(written_.wire); }

  void answered(Outcome<Reply> outcome) override {
    const std::unique_ptr<RestCall> self(this);
    reply_(response(outcome));
  }

 private:
  HttpResponse response(const Outcome<Reply>& outcome) const {
    try {
      if (!outcome.ok()) return error_response(outcome.error());
      return message_response(*outcome.message(), request_, !written_.has_read_mask);
    } catch (...) {
      return error_response(error_of_exception());
    }
  }

  const RouteMatch route_;
  HttpRequest request_;
  const std::shared_ptr<const std::atomic<bool>> cancelled_;
  const RestHandler::Reply reply_;
  bool is_prepared_ = false;
  WrittenRequest written_;
};

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

RestHandler::RestHandler(CallDispatcher& dispatcher, std::map<std::string, Page> pages)
    : dispatcher_(dispatcher), routes_(dispatcher.methods()), pages_(std::move(pages)) {}

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
    compress(encoding, response);
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
  if (!route->method->answer) {
    const std::string& name = route->method->descriptor->name();
    return answer(error_response(error(google::rpc::UNIMPLEMENTED, v1::ERROR_REASON_UNKNOWN_METHOD,
                                       name + " answers with a stream, which gRPC alone carries",
                                       {{"method", name}})));
  }
  if (auto wrong = wrong_body(request)) return answer(*std::move(wrong));
  auto* call = new RestCall(*std::move(route), std::move(request), std::move(cancelled), answer,
                            dispatcher_.limits().call);  // deletes itself
  dispatcher_.answer(*call);
}

}  // namespace tribodyn::server
