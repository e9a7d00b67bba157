#include "server/scheduling/progress_board.h"

#include <algorithm>
#include <utility>

namespace tribodyn::server {

void ProgressChannel::publish_event(std::int64_t sequence) {
  {
    const std::lock_guard lock(mutex_);
    if (sequence <= latest_.sequence) return;
    latest_.sequence = sequence;
    latest_.progress = {};
  }
  observers_.tell();
}

void ProgressChannel::publish_progress(Progress progress) {
  {
    const std::lock_guard lock(mutex_);
    progress.fraction = std::max(progress.fraction, latest_.progress.fraction);
    latest_.progress = std::move(progress);
    progress_number_ = ++latest_.progress_number;
  }
  observers_.tell();
}

ProgressChannel::Latest ProgressChannel::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

std::shared_ptr<ProgressChannel> ProgressBoard::open(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<ProgressChannel>& channel = channels_[id];
  if (!channel) channel = std::make_shared<ProgressChannel>();
  return channel;
}

std::shared_ptr<ProgressChannel> ProgressBoard::find(std::int64_t id) const {
  const std::lock_guard lock(mutex_);
  const auto found = channels_.find(id);
  return found == channels_.end() ? nullptr : found->second;
}

void ProgressBoard::finish(std::int64_t id, std::int64_t sequence) {
  std::shared_ptr<ProgressChannel> channel;
  {
    const std::lock_guard lock(mutex_);
    const auto found = channels_.find(id);
    if (found == channels_.end()) return;
    channel = std::move(found->second);
    channels_.erase(found);
  }
  channel->publish_event(sequence);
}

}  // namespace tribodyn::server
