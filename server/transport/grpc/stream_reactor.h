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
#include "server/application/message_source.h"
#include "server/application/outcome.h"
#include "server/transport/grpc/grpc_status.h"
#include "server/transport/grpc/live_streams.h"

namespace tribodyn::server {

/// Pumps a MessageSource into a gRPC stream: one message under way at a time, the next one only
/// from OnWriteDone or, when the source had nothing, when the source says that something changed.
/// Safe for concurrent access: whoever holds `busy_` owns source and stream; nobody holds the mutex
/// while calling into gRPC. Keeps itself alive until OnDone. At its end it is closed with
/// DEADLINE_EXCEEDED. A client that reads nothing, so that a write stays under way, is cut off: at
/// the end, or once that write has taken too long. Of a message on its way only the bytes are kept,
/// so that many readers of large ones cost half.
template <class Message>
class StreamReactor final : public grpc::ServerWriteReactor<grpc::ByteBuffer>,
                            public ProgressObserver,
                            public LiveStream,
                            public std::enable_shared_from_this<StreamReactor<Message>> {
 public:
  using Source = std::shared_ptr<MessageSource<Message>>;

  using Clock = std::chrono::system_clock;
  using StopWatch = std::chrono::steady_clock;

  StreamReactor(LiveStreams& live, grpc::CallbackServerContext& context, Clock::duration unread)
      : live_(live), context_(&context), unread_(unread) {}

  /// A stream of the messages of the source that `open` gives, or one that ends at once with the
  /// error. It may last for `left`, and one write of it for `unread`.
  template <class Open>
  static grpc::ServerWriteReactor<grpc::ByteBuffer>* start(LiveStreams& live,
                                                           grpc::CallbackServerContext& context,
                                                           Clock::duration left,
                                                           Clock::duration unread,
                                                           const Open& open) {
    auto reactor = std::make_shared<StreamReactor>(live, context, unread);
    reactor->self_ = reactor;
    std::optional<google::rpc::Status> refused;
    Outcome<Source> outcome = open();
    if (outcome.ok()) {
      refused = live.add(reactor);
    } else {
      refused = outcome.error();
    }
    if (refused) {
      reactor->close(*refused);
      return reactor.get();
    }
    reactor->source_ = std::move(outcome.message());
    reactor->source_->observe(reactor);
    reactor->end_at(Clock::now() + left);
    reactor->check_writes_at(Clock::now() + unread);
    reactor->changed();
    return reactor.get();
  }

  void changed() override {
    {
      const std::lock_guard lock(mutex_);
      if (finished_) return;
      again_ = true;
      if (busy_) return;
      busy_ = true;
    }
    send_next();
  }

  void close(const google::rpc::Status& status) override {
    {
      const std::lock_guard lock(mutex_);
      if (finished_) return;
      if (busy_) {
        if (!closing_) closing_ = status;
        return;
      }
      finished_ = true;
    }
    this->Finish(to_grpc(status));
  }

  void OnWriteDone(bool ok) override {
    {
      const std::lock_guard lock(mutex_);
      writing_since_.reset();
    }
    if (!ok)
      return finish(
          error(google::rpc::CANCELLED, v1::ERROR_REASON_CANCELLED, "the client is gone"));
    send_next();
  }

  void OnCancel() override {
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
    const std::weak_ptr<StreamReactor> weak = this->weak_from_this();
    alarm_.Set(end, [weak, end](bool rings) {
      const auto self = rings ? weak.lock() : nullptr;
      if (!self) return;
      self->close(stream_deadline_exceeded());
      self->cut_off_at(std::max(end, Clock::now()) + kLastWrite);
    });
  }

  void cut_off_at(Clock::time_point time) {
    const std::weak_ptr<StreamReactor> weak = this->weak_from_this();
    last_alarm_.Set(time, [weak](bool rings) {
      if (const auto self = rings ? weak.lock() : nullptr) self->cut_off();
    });
  }

  /// Looks then, and again whenever a write that is under way may have taken too long.
  void check_writes_at(Clock::time_point time) {
    const std::weak_ptr<StreamReactor> weak = this->weak_from_this();
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

  using Step = typename MessageSource<Message>::Step;

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
          return this->StartWrite(&bytes_);
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
    Message message;
    const Step step = next_step(*source_, message, end_);
    if (step != Step::kMessage) return step;
    bool own = false;
    const grpc::Status status =
        grpc::SerializationTraits<Message>::Serialize(message, &bytes_, &own);
    if (status.ok()) return step;
    end_ = internal_error("a message of a stream cannot be serialised: " + status.error_message());
    return Step::kEnd;
  }

  void finish(const google::rpc::Status& status) {
    {
      const std::lock_guard lock(mutex_);
      finished_ = true;
    }
    this->Finish(to_grpc(status));
  }

  LiveStreams& live_;
  // Recursive: TryCancel may call OnDone before it returns.
  std::recursive_mutex context_mutex_;
  grpc::CallbackServerContext* context_;  // guarded by context_mutex_; null once done
  grpc::Alarm alarm_;
  grpc::Alarm last_alarm_;                    // set by alarm_ alone
  std::shared_ptr<grpc::Alarm> write_alarm_;  // set by start, then by itself alone
  const Clock::duration unread_;
  Source source_;            // owner of busy_
  grpc::ByteBuffer bytes_;   // owner of busy_
  google::rpc::Status end_;  // owner of busy_
  std::mutex mutex_;
  bool busy_ = false;      // guarded by mutex_
  bool again_ = false;     // guarded by mutex_
  bool finished_ = false;  // guarded by mutex_; stays set once Finish is called
  std::optional<google::rpc::Status> closing_;          // guarded by mutex_
  std::optional<StopWatch::time_point> writing_since_;  // guarded by mutex_
  std::shared_ptr<StreamReactor> self_;
};

}  // namespace tribodyn::server
