#include "server/jobs/progress_board.h"

#include <algorithm>
#include <utility>

namespace tribodyn::server {

void ProgressChannel::publish(Progress progress) {
  std::vector<std::shared_ptr<ProgressObserver>> told;
  {
    const std::lock_guard lock(mutex_);
    if (has_ended(latest_.state)) return;
    if (progress.state == latest_.state) {
      progress.fraction = std::max(progress.fraction, latest_.fraction);
    }
    latest_ = std::move(progress);
    ++number_;
    for (const auto& weak : observers_) {
      if (auto observer = weak.lock()) told.push_back(std::move(observer));
    }
  }
  for (const auto& observer : told) observer->changed();
}

ProgressChannel::Numbered ProgressChannel::latest() const {
  const std::lock_guard lock(mutex_);
  return {number_, latest_};
}

void ProgressChannel::observe(const std::weak_ptr<ProgressObserver>& observer) {
  const std::lock_guard lock(mutex_);
  std::erase_if(observers_, [](const auto& weak) { return weak.expired(); });
  observers_.push_back(observer);
}

std::shared_ptr<ProgressChannel> ProgressBoard::open(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<ProgressChannel>& channel = channels_[id];
  if (!channel) channel = std::make_shared<ProgressChannel>(Progress{});
  return channel;
}

std::shared_ptr<ProgressChannel> ProgressBoard::find(std::int64_t id) const {
  const std::lock_guard lock(mutex_);
  const auto found = channels_.find(id);
  return found == channels_.end() ? nullptr : found->second;
}

void ProgressBoard::finish(std::int64_t id, Progress end) {
  std::shared_ptr<ProgressChannel> channel;
  {
    const std::lock_guard lock(mutex_);
    const auto found = channels_.find(id);
    if (found == channels_.end()) return;
    channel = std::move(found->second);
    channels_.erase(found);
  }
  channel->publish(std::move(end));
}

}  // namespace tribodyn::server
