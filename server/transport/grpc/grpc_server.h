#pragma once

#include <grpcpp/server.h>

#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/application/call_dispatcher.h"
#include "server/application/live_streams.h"
#include "server/transport/acceptor.h"
#include "server/transport/grpc/open_call_watch.h"
#include "server/transport/grpc/services.h"
#include "server/transport/grpc/unknown_methods.h"
#include "server/transport/listen_address.h"
#include "server/transport/tls_files.h"

namespace tribodyn::server {

/// The gRPC server, with health checks and reflection. The constructor starts it. The same thread
/// must call shutdown() and the destructor.
class GrpcServer {
 public:
  /// Listens at all addresses, with TLS at those that other machines reach. `dispatcher` must
  /// outlive the object. Throws ListenError, also if such an address comes without `tls`.
  GrpcServer(CallDispatcher& dispatcher, const std::vector<ListenAddress>& addresses,
             const TlsFiles& tls = {});
  ~GrpcServer();
  GrpcServer(const GrpcServer&) = delete;
  GrpcServer& operator=(const GrpcServer&) = delete;

  /// Returns the addresses in their order, with actual ports.
  std::vector<std::string> addresses() const;

  /// Sets the answer to health checks. It is NOT_SERVING at first.
  void set_serving(bool serving);
  bool is_serving() const { return is_serving_; }

  /// Accepts no further calls, ends every stream with UNAVAILABLE and waits for the other calls.
  void shutdown();

 private:
  std::atomic<bool> is_serving_ = false;
  std::deque<Acceptor> acceptors_;
  const std::shared_ptr<LiveStreams> live_;
  std::vector<std::unique_ptr<grpc::Service>> services_;
  UnknownMethods unknown_methods_;
  std::unique_ptr<grpc::Server> server_;
  std::optional<OpenCallWatch> open_calls_;
};

}  // namespace tribodyn::server
