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
/// one at a time, the next one only when the one before is written, so that no more than one
/// message waits for a slow client. Pulls again when the source reports a change. Closes the stream
/// at its end, or when the transport or a shutdown requests it, as soon as no write is under way;
/// cuts off a client that reads nothing. Safe for concurrent access: the thread that brings it into
/// kAsking or kWriting owns the source until it leaves that state.
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

  /// Asks the source soon.
  void changed() override;
  /// Ends the stream once no write is under way. The first of several statuses counts.
  void close(const google::rpc::Status& status);
  /// A write has ended; `ok` is false if the client is gone.
  void written(bool ok);
  /// Pulls from the source, and writes or ends. Only the two functions of StreamTransport above may
  /// call it.
  void step();

  /// Closes the stream at its end, and cuts off a client that has not read a message for `unread`,
  /// or for kLastWrite after the end. Returns the time at which to call it again; nullopt: never.
  /// Called for the first time at any time after open().
  std::optional<Clock::time_point> look_at_clock(Clock::time_point now = Clock::now());
  static constexpr auto kLastWrite = std::chrono::seconds(5);

 private:
  enum class State {
    kOpening,
    kIdle,     ///< the source had nothing
    kAsking,   ///< a step runs or will run
    kWriting,  ///< a write is under way
    kFinished
  };

  void finish(const google::rpc::Status& status);
  /// Returns the status with which to end now; nullopt: go on.
  std::optional<google::rpc::Status> begin_step();
  /// Returns false if the source must be asked again.
  bool go_idle();

  StreamTransport& transport_;
  const google::protobuf::Message& prototype_;
  const Clock::duration unread_;
  ReplySource source_;  // set by open(); then the owner's
  std::mutex mutex_;
  State state_ = State::kOpening;  // guarded by mutex_
  bool again_ = false;             // guarded by mutex_; changed since the last step began
  std::optional<google::rpc::Status> closing_;  // guarded by mutex_
  Clock::time_point end_;                       // guarded by mutex_
  Clock::time_point writing_since_;             // guarded by mutex_; of kWriting
};

}  // namespace tribodyn::server
