#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "server/application/call_dispatcher.h"
#include "server/application/live_streams.h"
#include "server/transport/http/http_message.h"
#include "server/transport/http/http_routes.h"
#include "server/transport/http/session_cookie.h"
#include "server/transport/http/static_files.h"
#include "server/transport/http/stream_format.h"

namespace tribodyn::server {

/// What the streams of a RestHandler may take.
struct RestLimits {
  std::size_t streams = 1500;  ///< open at a time; other calls have the other connections
  std::size_t streams_of_peer = 1200;
};

/// What a RestHandler serves to browsers beside the methods; null: nothing of it.
struct RestDashboard {
  std::shared_ptr<const SessionCookies> sessions = nullptr;
  std::shared_ptr<const StaticFiles> files = nullptr;
};

/// Serves the methods of the contract as REST: requests in, responses out, whatever carries them.
/// Routes are those of google.api.http, bodies are protobuf's JSON, errors AIP-193's. Methods that
/// stream answer with server-sent events or JSON lines. Refuses what a web page of another origin
/// may send. Safe for concurrent access.
class RestHandler {
 public:
  /// A page of the server's own, by its path: GET and HEAD.
  struct Page {
    /// Called on the thread of handle().
    std::function<HttpResponse(const HttpRequest&)> answer;
    bool is_public = false;  ///< else only for those who may read about all projects
  };

  /// `dispatcher` must outlive the object. Throws std::logic_error as HttpRoutes does.
  explicit RestHandler(CallDispatcher& dispatcher, std::map<std::string, Page> pages = {},
                       const RestLimits& limits = {}, const RestDashboard& dashboard = {});
  ~RestHandler() { shut_down_streams(); }
  RestHandler(const RestHandler&) = delete;
  RestHandler& operator=(const RestHandler&) = delete;

  /// Called once, on any thread.
  using Reply = std::function<void(HttpResponse)>;

  /// Returns the longest body of a request with this verb and target [bytes]; 0 if it takes none.
  std::size_t maximum_body_bytes(const HttpRequest& head) const;

  /// Returns the answer to a request whose body is not worth reading: the caller shows no valid
  /// token. Else nullopt.
  std::optional<HttpResponse> refuse_head(const HttpRequest& head) const;

  /// Answers a request. `cancelled` is true once the client has gone.
  void handle(HttpRequest request, std::shared_ptr<const std::atomic<bool>> cancelled, Reply reply);

  /// Ends all streams with SHUTTING_DOWN and opens none any more.
  void shut_down_streams() { streams_->shut_down(); }

  /// A body may have so many times the bytes of the method's longest binary request: numbers in
  /// indented JSON take 3.2 times the bytes of the binary form. No body is longer than
  /// kMaximumBodyBytes.
  static constexpr std::size_t kJsonGrowth = 4;
  static constexpr std::size_t kMaximumBodyBytes = 64 << 20;

  const HttpRoutes& routes() const { return routes_; }

 private:
  CallDispatcher& dispatcher_;
  const HttpRoutes routes_;
  const std::map<std::string, Page> pages_;
  const RestDashboard dashboard_;
  const std::shared_ptr<LiveStreams> streams_;
  const std::shared_ptr<EventTexts> event_texts_ = std::make_shared<EventTexts>();
};

/// Returns the headers of every response, for those that are made without a handler.
const std::map<std::string, std::string>& security_headers();

}  // namespace tribodyn::server
