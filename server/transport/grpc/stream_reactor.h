#pragma once

#include <grpcpp/alarm.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "server/application/errors.h"
#include "server/transport/grpc/grpc_call.h"
#include "server/transport/grpc/grpc_status.h"
#include "server/transport/grpc/live_streams.h"

namespace tribodyn::server {

/// Pumps a MessageSource into a gRPC stream: one message under way at a time, the next one only
/// from OnWriteDone or, when the source had nothing, when the source says that something changed.
/// The source is opened and asked on the threads of the dispatcher. Safe for concurrent access:
/// whoever holds `busy_` owns source and stream, first whoever opens it; nobody holds the mutex
/// while calling into gRPC. Keeps itself alive until OnDone. At its end it is closed with
/// DEADLINE_EXCEEDED. A client that reads nothing, so that a write stays under way, is cut off: at
/// the end, or once that write has taken too long. Of a message on its way only the bytes are kept,
/// so that many readers of large ones cost half.
class StreamReactor final : public grpc::ServerWriteReactor<grpc::ByteBuffer>,
                            public GrpcCall<StreamCall>,
                            public ProgressObserver,
                            public LiveStream,
                            public std::enable_shared_from_this<StreamReactor> {
 public:
  using Clock = std::chrono::system_clock;
  using StopWatch = std::chrono::steady_clock;

  StreamReactor(CallDispatcher& dispatcher, LiveStreams& live, const Method& its_method,
                grpc::CallbackServerContext& its_context, const grpc::ByteBuffer& request)
      : GrpcCall(its_method, its_context, request, dispatcher.limits().stream),
        dispatcher_(dispatcher),
        live_(live),
        context_(&its_context),
        unread_(dispatcher.limits().unread) {}

  /// A stream of the messages of the method's source, or one that ends with its error. It lasts
  /// until the deadline of the call, and one write of it as long as the dispatcher's limit says.
  static grpc::ServerWriteReactor<grpc::ByteBuffer>* start(CallDispatcher& dispatcher,
                                                           LiveStreams& live, const Method& method,
                                                           grpc::CallbackServerContext& context,
                                                           const grpc::ByteBuffer& request) {
    auto reactor = std::make_shared<StreamReactor>(dispatcher, live, method, context, request);
    reactor->self_ = reactor;
    dispatcher.open(*reactor);
    return reactor.get();
  }

  void opened(Outcome<ReplySource> outcome) override {
    if (!outcome.ok()) return end_with(outcome.error());  // counted
    if (const auto refused = live_.add(shared_from_this())) return finish(*refused);
    source_ = std::move(outcome.message());
    source_->observe(weak_from_this());
    end_at(Clock::now() + std::chrono::duration_cast<Clock::duration>(context.limits.deadline -
                                                                      CallLimits::Clock::now()));
    check_writes_at(Clock::now() + unread_);
    ask_again();
  }

  void changed() override {
    {
      const std::lock_guard lock(mutex_);
      if (finished_) return;
      again_ = true;
      if (busy_) return;
      busy_ = true;
    }
    ask_again();
  }

  void close(const google::rpc::Status& status) override {
    {
      const std::lock_guard lock(mutex_);
      if (finished_) return;
      if (busy_) {
        if (!closing_) closing_ = status;
        return;
      }
      busy_ = true;
    }
    finish(status);
  }

  void OnWriteDone(bool ok) override {
    {
      const std::lock_guard lock(mutex_);
      writing_since_.reset();
    }
    if (!ok) {
      return finish(
          error(google::rpc::CANCELLED, v1::ERROR_REASON_CANCELLED, "the client is gone"));
    }
    ask_again();
  }

  void OnCancel() override {
    set_cancelled();
    close(error(google::rpc::CANCELLED, v1::ERROR_REASON_CANCELLED, "the client cancelled"));
  }

  void OnDone() override {
    {
      const std::lock_guard lock(context_mutex_);
      context_ = nullptr;
    }
    live_.remove(this);
    const auto last = std::move(self_);  // may destroy this object on leaving
  }

 private:
  static constexpr auto kLastWrite = std::chrono::seconds(5);

  void end_at(Clock::time_point end) {
    const std::weak_ptr<StreamReactor> weak = weak_from_this();
    alarm_.Set(end, [weak, end](bool rings) {
      const auto self = rings ? weak.lock() : nullptr;
      if (!self) return;
      self->close(stream_deadline_exceeded());
      self->cut_off_at(std::max(end, Clock::now()) + kLastWrite);
    });
  }

  void cut_off_at(Clock::time_point time) {
    const std::weak_ptr<StreamReactor> weak = weak_from_this();
    last_alarm_.Set(time, [weak](bool rings) {
      if (const auto self = rings ? weak.lock() : nullptr) self->cut_off();
    });
  }

  /// Looks then, and again whenever a write that is under way may have taken too long.
  void check_writes_at(Clock::time_point time) {
    const std::weak_ptr<StreamReactor> weak = weak_from_this();
    // One that rings cannot be set again meanwhile; and this one may ring before Set has returned.
    const auto alarm = std::make_shared<grpc::Alarm>();
    write_alarm_ = alarm;
    alarm->Set(time, [weak](bool rings) {
      const auto self = rings ? weak.lock() : nullptr;
      if (!self) return;
      Clock::duration writing{0};
      {
        const std::lock_guard lock(self->mutex_);
        if (self->finished_) return;
        if (self->writing_since_) writing = StopWatch::now() - *self->writing_since_;
      }
      if (writing >= self->unread_) return self->cut_off();
      self->check_writes_at(Clock::now() + self->unread_ - writing);
    });
  }

  void cut_off() {
    const std::lock_guard lock(context_mutex_);
    if (context_ != nullptr) context_->TryCancel();
  }

  using Step = AnyMessageSource::Step;

  /// Only the owner of `busy_` calls it, so that the object is there when the step runs.
  void ask_again() {
    dispatcher_.step([this] { send_next(); });
  }

  /// The owner of `busy_` sends a message, ends the stream, or gives `busy_` back.
  void send_next() {
    for (;;) {
      std::optional<google::rpc::Status> closing;
      {
        const std::lock_guard lock(mutex_);
        again_ = false;
        closing = closing_;
      }
      if (closing) return finish(*closing);
      switch (ask_source()) {
        case Step::kMessage: {
          {
            const std::lock_guard lock(mutex_);
            writing_since_ = StopWatch::now();
          }
          return StartWrite(&bytes_);
        }
        case Step::kEnd:
          return finish(end_);
        case Step::kWait:
          break;
      }
      const std::lock_guard lock(mutex_);
      if (again_ || closing_) continue;
      busy_ = false;
      return;
    }
  }

  /// The next message, if there is one, in `bytes_`.
  Step ask_source() {
    bytes_.Clear();
    const Reply message(method.response->New());
    const Step step = next_step(*source_, *message, end_);
    if (step != Step::kMessage) return step;
    bool own = false;
    const grpc::Status status =
        grpc::SerializationTraits<google::protobuf::Message>::Serialize(*message, &bytes_, &own);
    if (status.ok()) return step;
    end_ = internal_error("a message of a stream cannot be serialised: " + status.error_message());
    return Step::kEnd;
  }

  void finish(const google::rpc::Status& status) {
    dispatcher_.ended(*this, status);
    end_with(status);
  }

  void end_with(const google::rpc::Status& status) {
    {
      const std::lock_guard lock(mutex_);
      finished_ = true;
    }
    Finish(to_grpc(status));
  }

  CallDispatcher& dispatcher_;
  LiveStreams& live_;
  // Recursive: TryCancel may call OnDone before it returns.
  std::recursive_mutex context_mutex_;
  grpc::CallbackServerContext* context_;  // guarded by context_mutex_; null once done
  grpc::Alarm alarm_;
  grpc::Alarm last_alarm_;                    // set by alarm_ alone
  std::shared_ptr<grpc::Alarm> write_alarm_;  // set by start, then by itself alone
  const Clock::duration unread_;
  ReplySource source_;       // owner of busy_
  grpc::ByteBuffer bytes_;   // owner of busy_
  google::rpc::Status end_;  // owner of busy_
  std::mutex mutex_;
  bool busy_ = true;       // guarded by mutex_; at first the owner opens the source
  bool again_ = false;     // guarded by mutex_
  bool finished_ = false;  // guarded by mutex_; stays set once Finish is called
  std::optional<google::rpc::Status> closing_;          // guarded by mutex_
  std::optional<StopWatch::time_point> writing_since_;  // guarded by mutex_
  std::shared_ptr<StreamReactor> self_;
};

}  // namespace tribodyn::server
