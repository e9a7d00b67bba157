#pragma once

#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "server/application/errors.h"
#include "server/application/live_streams.h"
#include "server/application/stream_machine.h"
#include "server/transport/grpc/grpc_call.h"
#include "server/transport/grpc/grpc_status.h"

namespace tribodyn::server {

/// A gRPC stream that a StreamMachine drives, on the threads of the dispatcher. Keeps itself alive
/// until OnDone. Of a message on its way only the bytes are kept, so that many readers of large
/// ones cost half.
class StreamReactor final : public grpc::ServerWriteReactor<grpc::ByteBuffer>,
                            public GrpcCall<StreamCall>,
                            public StreamTransport,
                            public LiveStream,
                            public std::enable_shared_from_this<StreamReactor> {
 public:
  StreamReactor(CallDispatcher& dispatcher, std::shared_ptr<LiveStreams> live,
                const Method& its_method, grpc::CallbackServerContext& its_context,
                const grpc::ByteBuffer& request)
      : GrpcCall(its_method, its_context, request, dispatcher.limits().stream),
        dispatcher_(dispatcher),
        live_(std::move(live)),
        machine_(*this, *its_method.response, dispatcher.limits().unread),
        context_(&its_context) {}

  /// Returns a stream of the messages of the method's source, or one that ends with its error. The
  /// stream lasts until the deadline of the call, and one write as long as the dispatcher's limit
  /// says.
  static grpc::ServerWriteReactor<grpc::ByteBuffer>* start(CallDispatcher& dispatcher,
                                                           std::shared_ptr<LiveStreams> live,
                                                           const Method& method,
                                                           grpc::CallbackServerContext& context,
                                                           const grpc::ByteBuffer& request) {
    auto reactor =
        std::make_shared<StreamReactor>(dispatcher, std::move(live), method, context, request);
    reactor->self_ = reactor;
    dispatcher.open(*reactor);
    return reactor.get();
  }

  void opened(Outcome<ReplySource> outcome) override {
    // The dispatcher has counted a refusal of its own.
    is_counted_ = !outcome.ok();
    if (!outcome.ok()) return machine_.refuse(outcome.error());
    const auto self = shared_from_this();
    if (const auto refused = live_->add(self)) return machine_.refuse(*refused);
    outcome.message()->observe(std::shared_ptr<Observer>(self, &machine_));
    machine_.open(std::move(outcome.message()), context.limits.deadline);
    live_->follow_clock(*this);
  }

  void shut_down(const google::rpc::Status& status) override { machine_.shut_down(status); }
  std::optional<StreamMachine::Clock::time_point> look_at_clock() override {
    return machine_.look_at_clock();
  }
  void OnWriteDone(bool ok) override {
    bytes_.Clear();
    machine_.written(ok);
  }
  void OnCancel() override {
    set_cancelled();
    machine_.close(
        error(google::rpc::CANCELLED, v1::ERROR_REASON_CANCELLED, "the client cancelled"));
  }
  void OnDone() override {
    {
      const std::lock_guard lock(context_mutex_);
      context_ = nullptr;
    }
    live_->remove(this);
    const auto last = std::move(self_);  // may destroy this object on leaving
  }

 private:
  void run_step() override {
    dispatcher_.step([this] { machine_.step(); });
  }
  void run_short_step() override {
    dispatcher_.short_step([this] { machine_.step(); });
  }
  std::optional<google::rpc::Status> write(const google::protobuf::Message& message) override {
    bytes_.Clear();
    bool own = false;
    const grpc::Status status =
        grpc::SerializationTraits<google::protobuf::Message>::Serialize(message, &bytes_, &own);
    if (!status.ok()) {
      return internal_error("a message of a stream cannot be serialised: " +
                            status.error_message());
    }
    StartWrite(&bytes_);
    return std::nullopt;
  }
  void finish(const google::rpc::Status& status) override {
    if (!is_counted_) dispatcher_.ended(*this, status);
    Finish(to_grpc(status));
  }
  void cut_off() override {
    const std::lock_guard lock(context_mutex_);
    if (context_ != nullptr) context_->TryCancel();
  }

  CallDispatcher& dispatcher_;
  // Shared: the thread that opens the stream may use the object after the server's destructor.
  const std::shared_ptr<LiveStreams> live_;
  StreamMachine machine_;
  // Recursive: TryCancel may call OnDone before it returns.
  std::recursive_mutex context_mutex_;
  grpc::CallbackServerContext* context_;  // guarded by context_mutex_; null once done
  grpc::ByteBuffer bytes_;                // of the message that is being written
  bool is_counted_ = false;
  std::shared_ptr<StreamReactor> self_;
};

}  // namespace tribodyn::server
