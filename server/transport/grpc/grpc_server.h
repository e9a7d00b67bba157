#pragma once

#include <grpcpp/server.h>

#include <memory>
#include <string>
#include <vector>

#include "server/application/call_dispatcher.h"
#include "server/transport/acceptor.h"
#include "server/transport/grpc/live_streams.h"
#include "server/transport/grpc/services.h"
#include "server/transport/grpc/unknown_methods.h"
#include "server/transport/listen_address.h"

namespace tribodyn::server {

/// The gRPC server with health and reflection. Started by the constructor; `shutdown` and the
/// destructor from one thread.
class GrpcServer {
 public:
  /// Throws ListenError. `dispatcher` must outlive the object.
  GrpcServer(CallDispatcher& dispatcher, const ListenAddress& address);
  ~GrpcServer();
  GrpcServer(const GrpcServer&) = delete;
  GrpcServer& operator=(const GrpcServer&) = delete;

  /// Where it really listens, with the port that the system picked.
  std::string address() const { return to_text(acceptor_.address()); }

  /// What health checks are told; at first that it does not serve.
  void set_serving(bool serving);

  /// Accepts nothing new, ends every stream with UNAVAILABLE and waits for the rest.
  void shutdown();

 private:
  Acceptor acceptor_;
  LiveStreams live_;
  std::vector<std::unique_ptr<grpc::Service>> services_;
  UnknownMethods unknown_methods_;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace tribodyn::server
