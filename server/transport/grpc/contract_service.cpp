#include "server/transport/grpc/contract_service.h"

#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <grpcpp/impl/rpc_service_method.h>

#include <utility>

namespace tribodyn::server {

// Like the code that protoc generates for raw callback methods.

using grpc::ByteBuffer;
using grpc::internal::RpcMethod;

void ContractService::add_unary(const google::protobuf::MethodDescriptor& method,
                                StartUnary start) {
  add(method, new grpc::internal::CallbackUnaryHandler<ByteBuffer, ByteBuffer>(std::move(start)));
}

void ContractService::add_stream(const google::protobuf::MethodDescriptor& method,
                                 StartStream start) {
  add(method,
      new grpc::internal::CallbackServerStreamingHandler<ByteBuffer, ByteBuffer>(std::move(start)));
}

/// gRPC takes ownership of the handler.
void ContractService::add(const google::protobuf::MethodDescriptor& method,
                          grpc::internal::MethodHandler* handler) {
  const int index = size();
  paths_.push_back("/" + method.service()->full_name() + "/" + method.name());
  const auto type = method.server_streaming() ? RpcMethod::SERVER_STREAMING : RpcMethod::NORMAL_RPC;
  AddMethod(new grpc::internal::RpcServiceMethod(paths_.back().c_str(), type, nullptr));
  MarkMethodRawCallback(index, handler);
}

}  // namespace tribodyn::server
