#pragma once

#include <google/protobuf/message.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>

#include "google/rpc/status.pb.h"
#include "server/application/message_source.h"
#include "server/application/method_table.h"
#include "server/support/observers.h"

namespace tribodyn::server {

/// What a StreamMachine needs of its transport. It calls none of these functions with its lock
/// held.
class StreamTransport {
 public:
  virtual ~StreamTransport() = default;
  /// Calls StreamMachine::step() soon, on another thread.
  virtual void run_step() = 0;
  /// Calls StreamMachine::step(), which takes about a millisecond, now or soon, on any thread.
  virtual void run_short_step() { run_step(); }
  /// Begins to write a message, and calls StreamMachine::written() once at its end, on any thread.
  /// Returns an error, and begins nothing, if the message cannot be written.
  virtual std::optional<google::rpc::Status> write(const google::protobuf::Message& message) = 0;
  /// Ends the stream. Called once, after the last write has ended.
  virtual void finish(const google::rpc::Status& status) = 0;
  /// Makes a write that is under way fail, if the stream still exists. May be called after
  /// finish().
  virtual void cut_off() = 0;
};

/// The states of one server stream, for every transport: pulls the messages of a source and writes
/// one at a time. While a message is written, the next one is prepared if the source allows it, and
/// no more than these two wait for a slow client. Pulls again when the source reports a change.
/// Closes the stream at its end, or when the transport requests it, as soon as no write is under
/// way, and at a shutdown as shut_down() says; cuts off a client that reads nothing. Safe for
/// concurrent access: the thread that takes a step owns the source until the end of the step.
class StreamMachine : public Observer {
 public:
  using Clock = std::chrono::steady_clock;

  /// A client may take `unread` to read a message. `transport` must outlive the object.
  StreamMachine(StreamTransport& transport, const google::protobuf::Message& prototype,
                Clock::duration unread)
      : transport_(transport), prototype_(prototype), unread_(unread) {}

  /// Starts a stream that lasts until `end`, and pulls the first message on the calling thread.
  /// Called once, and so is refuse() instead.
  void open(ReplySource source, Clock::time_point end);
  /// Ends a stream that was not opened.
  void refuse(const google::rpc::Status& status);

  /// Pulls from the source soon.
  void changed() override;
  /// Ends the stream once no write is under way. The first status of several calls counts,
  /// also over that of a shut_down() which still waits for the source.
  void close(const google::rpc::Status& status);
  /// Ends a stream that follows changes as soon as its source has no message, or by the first step
  /// after kLastChanges, and any other stream once no write is under way.
  void shut_down(const google::rpc::Status& status);
  /// Less than the second after which transports cut off at a shutdown, so that a watch that has
  /// many events to send still ends with its status.
  static constexpr auto kLastChanges = std::chrono::milliseconds(500);
  /// A write has ended; `ok` is false if the client is gone.
  void written(bool ok);
  /// Takes a step: writes the prepared message, or pulls one and writes or keeps it, or ends. Only
  /// the two functions of StreamTransport above may call it.
  void step();

  /// Closes the stream at its end, and cuts off a client that has not read a message for `unread`,
  /// or for kLastWrite after the end. Returns the time at which to call it again; nullopt: never.
  /// Called for the first time at any time after open().
  std::optional<Clock::time_point> look_at_clock(Clock::time_point now = Clock::now());
  static constexpr auto kLastWrite = std::chrono::seconds(5);

 private:
  enum class Closing {
    kNo,
    kWhenIdle,  ///< as soon as the source has no message, or by the first step after kLastChanges
    kNow,       ///< as soon as no write is under way
  };
  /// Returns true if only an event can cause a step. Requires the lock.
  bool is_idle() const;
  /// Ends the stream. `lock` is that of mutex_.
  void finish(std::unique_lock<std::mutex> lock, google::rpc::Status status);
  /// Moves the prepared message, or null, to `prepared`. Returns false if the step is over.
  bool begin_step(Reply& prepared);
  /// Returns true if the message must be written now. Otherwise the step is over, and the end of
  /// the present write causes the one that writes the message. `is_ahead`: a step follows at once.
  bool begin_write(Reply& message, bool is_ahead);
  /// Returns true if the stream is to close: the step is over, and so is the stream unless a write
  /// is under way.
  bool has_closed(std::unique_lock<std::mutex>& lock);
  /// Ends a step in which the source had nothing. Returns false if the step must go on, because of
  /// a change or to end the stream.
  bool go_idle();

  StreamTransport& transport_;
  const google::protobuf::Message& prototype_;
  const Clock::duration unread_;
  // Set by open(). Later only the thread that takes a step pulls from the source.
  ReplySource source_;
  std::mutex mutex_;
  // All below are guarded by mutex_.
  bool is_open_ = false;
  bool is_stepping_ = false;  // a step runs or will run
  bool is_writing_ = false;   // a write is under way
  bool is_finished_ = false;
  bool again_ = false;  // changed, or shut down, since the last step began
  Reply prepared_;      // while a write is under way: the next message
  Closing closing_ = Closing::kNo;
  google::rpc::Status status_;         // with which the stream closes
  Clock::time_point closing_at_last_;  // of a stream that closes when idle
  Clock::time_point end_;
  Clock::time_point writing_since_;  // of the write under way
};

}  // namespace tribodyn::server
