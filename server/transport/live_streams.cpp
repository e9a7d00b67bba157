#include "server/transport/live_streams.h"

#include <fmt/format.h>

#include <utility>

#include "server/application/errors.h"

namespace tribodyn::server {
namespace {

constexpr double kRetrySeconds = 10;

google::rpc::Status too_many(std::size_t maximum, const char* whose) {
  return exhausted(v1::ERROR_REASON_TOO_MANY_STREAMS,
                   fmt::format("{} streams{} are open, which is the limit; try again in {} s",
                               maximum, whose, kRetrySeconds),
                   kRetrySeconds);
}

}  // namespace

std::optional<google::rpc::Status> LiveStreams::add(const std::shared_ptr<LiveStream>& stream,
                                                    const std::string& peer) {
  const std::lock_guard lock(mutex_);
  if (closed_) return shutting_down();
  if (streams_.size() >= maximum_) return too_many(maximum_, "");
  const auto of_peer = of_peers_.find(peer);
  if (of_peer != of_peers_.end() && of_peer->second >= maximum_of_peer_) {
    return too_many(maximum_of_peer_, " of this client");
  }
  streams_[stream.get()] = {stream, peer};
  ++of_peers_[peer];
  return std::nullopt;
}

void LiveStreams::remove(const LiveStream* stream) {
  Entry last;  // destroyed after the lock is gone
  const std::lock_guard lock(mutex_);
  const auto found = streams_.find(stream);
  if (found == streams_.end()) return;
  last = std::move(found->second);
  streams_.erase(found);
  const auto of_peer = of_peers_.find(last.peer);
  if (--of_peer->second == 0) of_peers_.erase(of_peer);
}

void LiveStreams::shut_down() {
  std::map<const LiveStream*, Entry> open;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    open = streams_;
  }
  for (const auto& [key, entry] : open) entry.stream->shut_down(shutting_down());
}

}  // namespace tribodyn::server
