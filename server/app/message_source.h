#pragma once

#include <memory>

#include "google/rpc/status.pb.h"
#include "server/jobs/progress_board.h"

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

}  // namespace tribodyn::server
