#pragma once

#include <google/protobuf/message.h>

#include <memory>
#include <string>

#include "google/rpc/status.pb.h"
#include "server/application/guard.h"
#include "server/support/observers.h"

namespace tribodyn::server {

/// The messages of a server stream, pulled one by one so that a slow reader holds up nobody and
/// nothing piles up. Not safe for concurrent access.
class AnyMessageSource {
 public:
  enum class Step {
    kMessage,  ///< `out` is the next message
    kWait,     ///< nothing yet; the observer is told when to ask again
    kEnd,      ///< no more; error() says whether that is well
  };
  /// The order of a source of columns.
  enum class Order {
    kChunks,   ///< long runs of rows, each column of a run in a message
    kRows,     ///< the same in short runs, for a reader that keeps a whole run
    kColumns,  ///< each column to its end before the next one
  };
  virtual ~AnyMessageSource() = default;
  /// Sets the order of a source of columns; kChunks at first. Called before `next_message`.
  virtual void set_order(Order) {}
  /// `out` must be of the type of the source.
  virtual Step next_message(google::protobuf::Message& out) = 0;
  /// Starts telling the observer. Called once, before `next_message`.
  virtual void observe(const std::weak_ptr<Observer>&) {}
  /// Returns true if each message takes about a millisecond or less. Constant.
  virtual bool is_short() const { return false; }
  /// Returns true if the messages report changes as they happen: a shutdown ends the stream after
  /// the message of the last change, and any other stream at once. Constant.
  virtual bool follows_changes() const { return false; }
  /// Returns a text that all sources of the same messages share, and no others; "" if the messages
  /// may change.
  virtual std::string tag() const { return {}; }
  /// Returns false if the source has nothing to say before the observer's next notification. Takes
  /// about a microsecond.
  virtual bool may_continue() const { return true; }
  /// Returns true if the next message may be pulled before the present one is written: it will not
  /// change meanwhile, and two messages are not too large.
  virtual bool may_be_ahead() const { return false; }
  /// OK (code 0) or why the stream broke off.
  virtual google::rpc::Status error() const { return {}; }
};

/// A source of messages of one type.
template <class Message>
class MessageSource : public AnyMessageSource {
 public:
  Step next_message(google::protobuf::Message& out) final {
    return next(static_cast<Message&>(out));
  }
  virtual Step next(Message& out) = 0;
};

/// The next step of a source. A failure ends the stream: `end` says how it ended.
inline AnyMessageSource::Step next_step(AnyMessageSource& source, google::protobuf::Message& out,
                                        google::rpc::Status& end) {
  using Step = AnyMessageSource::Step;
  try {
    const Step step = source.next_message(out);
    if (step == Step::kEnd) end = source.error();
    return step;
  } catch (...) {
    end = error_of_exception();
  }
  return Step::kEnd;
}

}  // namespace tribodyn::server
