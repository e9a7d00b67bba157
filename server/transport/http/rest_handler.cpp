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
#include "server/support/sha256.h"
#include "server/support/text.h"
#include "server/transport/http/byte_range.h"
#include "server/transport/http/curve_table.h"
#include "server/transport/http/history_format.h"
#include "server/transport/http/media_types.h"
#include "server/transport/http/method_forms.h"
#include "server/transport/http/rest_answer.h"
#include "server/transport/http/rest_call.h"
#include "server/transport/http/rest_stream.h"
#include "server/transport/http/stream_format.h"

namespace tribodyn::server {
namespace {

/// Of an answer in its binary form [bytes]. While a message becomes JSON, it takes 40 times as much
/// memory (measured).
constexpr std::size_t kMostAnsweredBytes = 16 << 20;
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
/// its address, and every page reaches loopback. With TLS the server has the names of its
/// certificate, which the browser checks. Returns nullopt if the request is welcome.
std::optional<HttpResponse> foreign_origin(const HttpRequest& request) {
  const std::string_view authority = request.header("host");
  const std::string_view host = host_of(authority);
  if (!request.is_encrypted && host != "localhost" && host != "127.0.0.1" && host != "[::1]") {
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

/// A request for the points of a simulation as columns.
struct TableRequest {
  Form form;
  std::vector<std::string> columns;  ///< empty: all
};

/// Takes the columns out of the query and puts the view of the whole result in its place. Returns
/// nullopt, and a refusal, if the query has any other parameter than these and "alt".
std::optional<TableRequest> take_table(Form form, HttpRequest& request, HttpResponse& refusal) {
  TableRequest out{form, {}};
  std::string_view query = request.target;
  query.remove_prefix(std::min(query.find('?'), query.size()));
  while (!query.empty()) {
    query.remove_prefix(1);
    const std::string_view pair = query.substr(0, query.find('&'));
    query.remove_prefix(pair.size());
    const std::size_t equals = std::min(pair.find('='), pair.size());
    const auto value = percent_decoded(pair.substr(std::min(equals + 1, pair.size())));
    if (pair.empty() || pair.starts_with("alt=")) continue;
    if (!pair.starts_with("columns=") || !value) {
      refusal = http_error(
          400, "a table takes the parameters alt and columns, not " + plain_excerpt(pair));
      return std::nullopt;
    }
    std::string_view list = *value;
    while (!list.empty()) {
      const std::string_view name = take_part(list, ',');
      if (!name.empty()) out.columns.emplace_back(name);
    }
  }
  request.target = std::string(path_of(request)) + "?view=SIMULATION_VIEW_FULL";
  return out;
}

/// A unary call over HTTP; deletes itself once it has been answered.
class RestUnary final : public RestCall<UnaryCall> {
 public:
  RestUnary(RouteMatch its_route, HttpRequest its_request,
            std::shared_ptr<const std::atomic<bool>> cancelled, RestHandler::Reply reply,
            std::chrono::milliseconds limit, std::optional<TableRequest> table)
      : RestCall(std::move(its_route), std::move(its_request), std::move(cancelled), limit),
        reply_(std::move(reply)),
        table_(std::move(table)) {}

  void answered(Outcome<Reply> outcome) override {
    const std::unique_ptr<RestUnary> self(this);
    reply_(response(outcome));
  }

 private:
  HttpResponse response(const Outcome<Reply>& outcome) const {
    try {
      if (!outcome.ok()) return error_response(outcome.error());
      if (table_) return table_response(static_cast<const v1::Simulation&>(*outcome.message()));
      if (const std::size_t bytes = outcome.message()->ByteSizeLong(); bytes > kMostAnsweredBytes) {
        return error_response(invalid(
            {{"read_mask", fmt::format("the answer has {} bytes in its binary form; allowed in "
                                       "JSON: {}. Choose fewer fields, read columns of a campaign "
                                       "with :read, or call by gRPC",
                                       bytes, kMostAnsweredBytes)}}));
      }
      return message_response(*outcome.message(), request, !written.has_read_mask);
    } catch (...) {
      return error_response(error_of_exception());
    }
  }

  HttpResponse table_response(const v1::Simulation& simulation) const {
    auto table = curve_table(simulation, table_->columns, table_->form);
    if (!table.ok()) return error_response(table.error());
    set_etag(sha256(table.message().body), request, table.message());
    if (table.message().status == 200) offer_range(request, table.message());
    return std::move(table.message());
  }

  const RestHandler::Reply reply_;
  const std::optional<TableRequest> table_;
};

std::unique_ptr<StreamFormat> stream_format(Form form, const Method& method,
                                            const std::shared_ptr<EventTexts>& texts) {
  if (form == Form::kEvents) return event_stream_format(*method.descriptor, texts);
  if (form == Form::kLines) return json_lines_format();
  return history_format(form);
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
                         const RestLimits& limits, const RestDashboard& dashboard)
    : dispatcher_(dispatcher),
      routes_(dispatcher.methods()),
      pages_(std::move(pages)),
      dashboard_(dashboard),
      streams_(std::make_shared<LiveStreams>(limits.streams, limits.streams_of_peer)) {}

std::size_t RestHandler::maximum_body_bytes(const HttpRequest& head) const {
  const auto route = routes_.find(head.verb, path_of(head));
  if (!route || route->body_field.empty()) return 0;
  return std::min(kMaximumBodyBytes,
                  kJsonGrowth * maximum_request_bytes(*route->method->descriptor));
}

std::optional<HttpResponse> RestHandler::refuse_head(const HttpRequest& head) const {
  HttpRequest request = head;
  std::optional<HttpResponse> refused;
  if (dashboard_.sessions) refused = dashboard_.sessions->admit(request, system_time());
  const auto grant = dispatcher_.authorizer().authenticate(credentials_of(request), system_time());
  if (!refused && grant.ok()) return std::nullopt;
  HttpResponse out = refused ? *std::move(refused) : error_response(grant.error());
  out.headers.insert(security_headers().begin(), security_headers().end());
  return out;
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
  if (dashboard_.sessions) {
    if (auto refused = dashboard_.sessions->admit(request, system_time())) {
      return answer(*std::move(refused));
    }
    if (path == SessionCookies::kPath) {
      return answer(dashboard_.sessions->answer(dispatcher_.authorizer(), request, system_time()));
    }
  }
  if (const auto page = pages_.find(path); page != pages_.end() && is_reading(request)) {
    if (!page->second.is_public) {
      const auto refused =
          dispatcher_.authorizer().refuse_overview(credentials_of(request), system_time());
      if (refused) return answer(error_response(*refused));
    }
    return answer(page->second.answer(request));
  }
  if (dashboard_.files) {
    if (auto file = dashboard_.files->answer(request, path)) return answer(*std::move(file));
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
    return open_rest_stream(dispatcher_, streams_, *std::move(route), std::move(request),
                            std::move(cancelled), stream_format(*form, method, event_texts_),
                            answer);
  }
  std::optional<TableRequest> table;
  if (*form != Form::kMessage) {
    table = take_table(*form, request, unacceptable);
    if (!table) return answer(std::move(unacceptable));
  }
  auto* call = new RestUnary(*std::move(route), std::move(request), std::move(cancelled), answer,
                             dispatcher_.limits().call, std::move(table));  // deletes itself
  dispatcher_.answer(*call);
}

}  // namespace tribodyn::server
