#pragma once

#include <exception>
#include <memory>
#include <new>

#include "google/rpc/status.pb.h"
#include "server/application/errors.h"
#include "server/scheduling/progress_board.h"

namespace tribodyn::server {

/// The messages of a server stream, pulled one by one so that a slow reader holds up nobody and
/// nothing piles up. Not safe for concurrent access.
template <class Message>
class MessageSource {
 public:
  enum class Step {
    kMessage,  ///< `out` is the next message
    kWait,     ///< nothing yet; the observer is told when to ask again
    kEnd,      ///< no more; error() says whether that is well
  };
  virtual ~MessageSource() = default;
  virtual Step next(Message& out) = 0;
  /// Starts telling the observer. Called once, before `next`.
  virtual void observe(const std::weak_ptr<ProgressObserver>&) {}
  /// OK (code 0) or why the stream broke off.
  virtual google::rpc::Status error() const { return {}; }
};

/// The next step of a source. A failure ends the stream: `end` says how it ended.
template <class Message>
typename MessageSource<Message>::Step next_step(MessageSource<Message>& source, Message& out,
                                                google::rpc::Status& end) {
  using Step = typename MessageSource<Message>::Step;
  try {
    const Step step = source.next(out);
    if (step == Step::kEnd) end = source.error();
    return step;
  } catch (const std::bad_alloc&) {
    end = out_of_memory();
  } catch (const std::exception& defect) {
    end = internal_error(defect.what());
  }
  return Step::kEnd;
}

}  // namespace tribodyn::server
