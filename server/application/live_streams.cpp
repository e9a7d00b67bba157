#include "server/application/live_streams.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <new>
#include <utility>

#include "server/application/errors.h"

namespace tribodyn::server {
namespace {

google::rpc::Status too_many(std::size_t maximum, const char* whose) {
  constexpr double kRetryLater = 10;  // [s]; most streams last longer, so somebody has to end one
  return exhausted(v1::ERROR_REASON_TOO_MANY_STREAMS,
                   fmt::format("{} streams{} are open, which is the limit; try again in {} s",
                               maximum, whose, kRetryLater),
                   kRetryLater);
}

}  // namespace

LiveStreams::LiveStreams(std::size_t maximum, std::size_t maximum_of_peer)
    : maximum_(maximum), maximum_of_peer_(maximum_of_peer), clock_([this] { run_clock(); }) {}

LiveStreams::~LiveStreams() { end_clock(); }

std::optional<google::rpc::Status> LiveStreams::add(const std::shared_ptr<LiveStream>& stream,
                                                    const std::string& peer) {
  const std::lock_guard lock(mutex_);
  if (closed_) return shutting_down();
  if (streams_.size() >= maximum_) return too_many(maximum_, "");
  const auto of_peer = of_peers_.find(peer);
  if (of_peer != of_peers_.end() && of_peer->second >= maximum_of_peer_) {
    return too_many(maximum_of_peer_, " of this client");
  }
  streams_[stream.get()] = {.stream = stream, .peer = peer};
  ++of_peers_[peer];
  return std::nullopt;
}

void LiveStreams::remove(const LiveStream* stream) {
  Entry last;  // declared before the lock, so that it is destroyed after the unlock
  const std::lock_guard lock(mutex_);
  const auto found = streams_.find(stream);
  if (found == streams_.end()) return;
  last = std::move(found->second);
  streams_.erase(found);
  const auto of_peer = of_peers_.find(last.peer);
  if (--of_peer->second == 0) of_peers_.erase(of_peer);
}

void LiveStreams::follow_clock(const LiveStream& stream) {
  set_next_look(stream, Clock::now() + kClockInterval);
}

void LiveStreams::look(LiveStream& stream) try {
  set_next_look(stream, stream.look_at_clock().value_or(Clock::time_point::max()));
} catch (const std::exception& failure) {  // no memory for a status: looked at again
  spdlog::error("event=internal_error cause=\"time limit of a stream: {}\"", failure.what());
}

void LiveStreams::set_next_look(const LiveStream& stream, Clock::time_point time) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = streams_.find(&stream);
    if (found == streams_.end()) return;
    found->second.next_look = time;
    if (time >= next_look_) return;
    next_look_ = time;
  }
  changed_.notify_one();
}

void LiveStreams::run_clock() {
  std::unique_lock lock(mutex_);
  while (!closed_) {
    if (Clock::now() < next_look_) {
      changed_.wait_until(lock, next_look_);
      continue;
    }
    std::vector<std::shared_ptr<LiveStream>> due;
    try {
      due = take_due(Clock::now());
    } catch (const std::bad_alloc&) {
      due.clear();  // nothing has changed; the next round tries again
    }
    lock.unlock();
    for (const auto& stream : due) look(*stream);
    due.clear();  // may destroy streams: without the lock
    lock.lock();
    changed_.wait_for(lock, kClockInterval, [this] { return closed_; });
  }
}

std::vector<std::shared_ptr<LiveStream>> LiveStreams::take_due(Clock::time_point now) {
  std::vector<std::shared_ptr<LiveStream>> due;
  due.reserve(streams_.size());  // throws, if at all, before any next look has changed
  next_look_ = Clock::time_point::max();
  for (auto& [stream, entry] : streams_) {
    if (entry.next_look <= now) {
      due.push_back(entry.stream);
      entry.next_look = now + kClockInterval;  // until look() has set it
    }
    next_look_ = std::min(next_look_, entry.next_look);
  }
  return due;
}

void LiveStreams::end_clock() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_one();
  std::call_once(clock_ended_, [this] { clock_.join(); });
}

void LiveStreams::shut_down() {
  end_clock();
  std::map<const LiveStream*, Entry> open;
  {
    const std::lock_guard lock(mutex_);
    open = streams_;
  }
  for (const auto& [key, entry] : open) entry.stream->shut_down(shutting_down());
}

}  // namespace tribodyn::server
