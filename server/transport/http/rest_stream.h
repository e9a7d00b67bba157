#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "server/application/call_dispatcher.h"
#include "server/application/live_streams.h"
#include "server/transport/http/http_message.h"
#include "server/transport/http/http_routes.h"
#include "server/transport/http/stream_format.h"

namespace tribodyn::server {

/// Answers a call of a method that streams: with a response whose body a StreamMachine makes, on
/// the threads of the dispatcher, or with its error. `dispatcher` must outlive the stream. `reply`
/// is called once, on any thread.
void open_rest_stream(CallDispatcher& dispatcher, std::shared_ptr<LiveStreams> live,
                      RouteMatch route, HttpRequest request,
                      std::shared_ptr<const std::atomic<bool>> cancelled,
                      std::unique_ptr<StreamFormat> format,
                      std::function<void(HttpResponse)> reply);

}  // namespace tribodyn::server
