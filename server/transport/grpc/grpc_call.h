#pragma once

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/proto_buffer_reader.h>
#include <grpcpp/support/server_callback.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "server/application/call_dispatcher.h"
#include "server/application/errors.h"

namespace tribodyn::server {

/// Returns the context of a call, from its metadata and its connection, which gRPC calls `peer`.
/// Its deadline is the client's, or `limit` from now if that is earlier.
CallContext call_context(const grpc::CallbackServerContext& context, const std::string& peer,
                         std::chrono::milliseconds limit, const std::atomic<bool>& cancelled);

/// Returns what a call brings to show who makes it: its header authorization and its connection.
Credentials credentials_of(const grpc::CallbackServerContext& context, const std::string& peer);

/// The common part of a UnaryCall and a StreamCall over gRPC. gRPC owns the request and keeps it
/// until OnDone; only this call uses it.
template <class Call>
class GrpcCall : public Call {
 public:
  GrpcCall(const Method& its_method, const grpc::CallbackServerContext& its_context,
           const grpc::ByteBuffer& request, std::chrono::milliseconds limit)
      : Call(its_method), request_(const_cast<grpc::ByteBuffer&>(request)) {
    const std::string peer = its_context.peer();
    this->context = call_context(its_context, peer, limit, cancelled_);
    this->context.sends_wire_format = true;
    this->credentials = credentials_of(its_context, peer);
  }

  /// gRPC also hands over a call that its client has ended before the request arrived: such a call
  /// is not one with an empty request.
  std::optional<google::rpc::Status> prepare() override {
    if (request_.Valid()) return std::nullopt;
    return error(google::rpc::CANCELLED, v1::ERROR_REASON_CANCELLED,
                 "the client ended the call before it had sent a request; nothing has changed");
  }
  std::size_t request_size() const override { return request_.Length(); }
  std::unique_ptr<google::protobuf::io::ZeroCopyInputStream> read_request() override {
    return std::make_unique<grpc::ProtoBufferReader>(&request_);
  }
  void drop_request() override { request_.Clear(); }
  /// gRPC calls callbacks from two threads or more, and any of them may take the next event.
  bool may_run_on_calling_thread() const override { return true; }

 protected:
  void set_cancelled() { cancelled_ = true; }

 private:
  grpc::ByteBuffer& request_;
  std::atomic<bool> cancelled_ = false;
};

}  // namespace tribodyn::server
