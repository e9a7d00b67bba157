// libFuzzer: sends arbitrary requests to the REST handler over a database with the seeds: verb,
// target, headers and body, and in them JSON, filters, page tokens and field masks. Each must be
// answered with a status, well-formed headers and, if it is an error, AIP-193's JSON; none may
// crash, hang or end in INTERNAL. An input is text: a line with the verb, "@" for a caller without
// token and the target, lines of headers, an empty line, the body.
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "server/support/sha256.h"
#include "server/transport/http/rest_handler.h"
#include "tests/fuzz/fuzzed_server.h"

namespace tribodyn::server {
namespace {

constexpr std::size_t kWrittenOneIn = 8;  // one in so many writing requests really writes
constexpr std::size_t kLargestAnswer =
    64 * 1024 * 1024;                                 // [bytes], five times gRPC's limit as JSON
constexpr auto kCallLimit = std::chrono::seconds(2);  // a point takes a second under sanitizers

/// The handler over a server in its initial state.
struct RestServer {
  FuzzedServer server;
  CallDispatcher dispatcher{server.application(), {.call = kCallLimit, .stream = kCallLimit}};
  RestHandler handler{dispatcher};
};

std::unique_ptr<RestServer>& rest_server() {
  // OpenSSL, which hashing begins, has to be cleaned up at exit after the server: threads that end
  // after it leak what it keeps for each of them.
  static const std::string kFirstHash = sha256("");
  static std::unique_ptr<RestServer> kServer;
  if (!kServer) {
    spdlog::set_level(spdlog::level::off);
    kServer = std::make_unique<RestServer>();
  }
  return kServer;
}

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

HttpRequest parse(std::string_view text) {
  HttpRequest out;
  std::string_view first = take_line(text);
  out.verb = first.substr(0, first.find(' '));
  first.remove_prefix(std::min(out.verb.size() + 1, first.size()));
  out.is_owner = !first.starts_with('@');
  if (!out.is_owner) first.remove_prefix(1);
  out.target = first;
  out.peer = "127.0.0.1";
  out.headers["host"] = "localhost";
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (line.empty()) break;
    const std::size_t colon = line.find(": ");
    if (colon == std::string_view::npos) continue;
    out.headers[std::string(line.substr(0, colon))] = line.substr(colon + 2);
  }
  out.body = text;
  if (!out.body.empty()) out.headers.try_emplace("content-type", "application/json");
  return out;
}

/// Makes most requests that would write only validate. Returns true if the request may write.
bool tame(HttpRequest& request, const HttpRoutes& routes, std::size_t choice) {
  const std::string path = request.target.substr(0, request.target.find('?'));
  const auto route = routes.find(request.verb, path);
  if (!route || route->method->scope == Scope::kRead) return false;
  const auto* field = route->method->descriptor->input_type()->FindFieldByName("validate_only");
  if (field == nullptr || route->body_field == "*" || choice % kWrittenOneIn == 0) return true;
  request.target += request.target.find('?') == std::string::npos ? '?' : '&';
  request.target += "validate_only=true";
  return false;
}

void judge(const HttpResponse& response) {
  require(response.status >= 200 && response.status < 600 && response.status != 500);
  require(response.body.size() <= kLargestAnswer);
  for (const auto& [name, value] : response.headers) {
    require(!name.empty());
    for (const char each : value) require(each >= ' ' && each <= '~');
  }
  if (response.headers.contains("Content-Encoding") || response.stream != nullptr) return;
  if (response.status < 400) return;
  const auto body = nlohmann::json::parse(response.body, nullptr, false);
  require(body.is_object() && body.contains("error"));
  require(body["error"]["code"] == response.status);
  require(!body["error"]["message"].get<std::string>().empty());
}

}  // namespace
}  // namespace tribodyn::server

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tribodyn::server;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  HttpRequest request = parse(text);
  RestServer& server = *rest_server();
  // The choice depends on the input, so that a crash can be repeated.
  const bool writes = tame(request, server.handler.routes(), std::hash<std::string_view>()(text));
  std::promise<HttpResponse> promise;
  server.handler.handle(std::move(request), std::make_shared<std::atomic<bool>>(false),
                        [&](HttpResponse response) { promise.set_value(std::move(response)); });
  const HttpResponse response = promise.get_future().get();
  judge(response);
  if (response.stream != nullptr) response.stream->hang_up();
  if (writes && response.status == 200) rest_server().reset();
  return 0;
}
