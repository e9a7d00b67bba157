#pragma once

#include <google/protobuf/descriptor.h>
#include <grpcpp/impl/codegen/service_type.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <deque>
#include <functional>
#include <string>

namespace tribodyn::server {

/// A gRPC service of the contract, bound by descriptors and not by generated stubs: every method
/// takes bytes and gives bytes, so that the server looks at a request before it is parsed.
class ContractService final : public grpc::Service {
 public:
  // They make the reactor of a call. Request and response are gRPC's and live until OnDone.
  using StartUnary = std::function<grpc::ServerUnaryReactor*(
      grpc::CallbackServerContext*, const grpc::ByteBuffer* request, grpc::ByteBuffer* response)>;
  using StartStream = std::function<grpc::ServerWriteReactor<grpc::ByteBuffer>*(
      grpc::CallbackServerContext*, const grpc::ByteBuffer* request)>;

  void add_unary(const google::protobuf::MethodDescriptor& method, StartUnary start);
  /// A method that answers one request with a stream.
  void add_stream(const google::protobuf::MethodDescriptor& method, StartStream start);
  int size() const { return static_cast<int>(paths_.size()); }

 private:
  void add(const google::protobuf::MethodDescriptor& method,
           grpc::internal::MethodHandler* handler);

  std::deque<std::string> paths_;  // gRPC keeps pointers to them
};

}  // namespace tribodyn::server
