#pragma once

#include <google/protobuf/descriptor.h>
#include <grpcpp/impl/codegen/service_type.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <deque>
#include <functional>
#include <string>

namespace tribodyn::server {

/// A gRPC service that is built from descriptors instead of generated code. Its methods take and
/// return bytes, so that the server can check a request before it parses it.
class ContractService final : public grpc::Service {
 public:
  // Make the reactor of a call. gRPC owns request and response until OnDone.
  using StartUnary = std::function<grpc::ServerUnaryReactor*(
      grpc::CallbackServerContext*, const grpc::ByteBuffer* request, grpc::ByteBuffer* response)>;
  using StartStream = std::function<grpc::ServerWriteReactor<grpc::ByteBuffer>*(
      grpc::CallbackServerContext*, const grpc::ByteBuffer* request)>;

  void add_unary(const google::protobuf::MethodDescriptor& method, StartUnary start);
  /// Adds a method that answers one request with a stream.
  void add_stream(const google::protobuf::MethodDescriptor& method, StartStream start);
  int size() const { return static_cast<int>(paths_.size()); }

 private:
  void add(const google::protobuf::MethodDescriptor& method,
           grpc::internal::MethodHandler* handler);

  std::deque<std::string> paths_;  // gRPC keeps pointers to the texts
};

}  // namespace tribodyn::server
