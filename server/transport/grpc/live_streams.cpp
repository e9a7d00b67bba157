#include "server/transport/grpc/live_streams.h"

#include <fmt/format.h>

#include "server/application/errors.h"

namespace tribodyn::server {
namespace {

constexpr double kRetrySeconds = 10;

}  // namespace

std::optional<google::rpc::Status> LiveStreams::add(const std::shared_ptr<LiveStream>& stream) {
  const std::lock_guard lock(mutex_);
  if (closed_) return shutting_down();
  if (streams_.size() >= maximum_) {
    return exhausted(v1::ERROR_REASON_TOO_MANY_STREAMS,
                     fmt::format("{} streams are open, which is the limit; try again in {} s",
                                 maximum_, kRetrySeconds),
                     kRetrySeconds);
  }
  streams_[stream.get()] = stream;
  return std::nullopt;
}

void LiveStreams::remove(const LiveStream* stream) {
  std::shared_ptr<LiveStream> last;  // destroyed after the lock is gone
  const std::lock_guard lock(mutex_);
  const auto found = streams_.find(stream);
  if (found == streams_.end()) return;
  last = std::move(found->second);
  streams_.erase(found);
}

void LiveStreams::close_all() {
  std::map<const LiveStream*, std::shared_ptr<LiveStream>> open;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    open = streams_;
  }
  for (const auto& [key, stream] : open) stream->close(shutting_down());
}

}  // namespace tribodyn::server
