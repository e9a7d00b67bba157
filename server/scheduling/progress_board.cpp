#include "server/scheduling/progress_board.h"

#include <algorithm>
#include <utility>

namespace tribodyn::server {

std::vector<std::shared_ptr<ProgressObserver>> ProgressChannel::living_observers() const {
  std::vector<std::shared_ptr<ProgressObserver>> out;
  for (const auto& weak : observers_) {
    if (auto observer = weak.lock()) out.push_back(std::move(observer));
  }
  return out;
}

void ProgressChannel::publish_event(std::int64_t sequence) {
  std::vector<std::shared_ptr<ProgressObserver>> told;
  {
    const std::lock_guard lock(mutex_);
    if (sequence <= latest_.sequence) return;
    latest_.sequence = sequence;
    latest_.progress = {};
    told = living_observers();
  }
  for (const auto& observer : told) observer->changed();
}

void ProgressChannel::publish_progress(Progress progress) {
  std::vector<std::shared_ptr<ProgressObserver>> told;
  {
    const std::lock_guard lock(mutex_);
    progress.fraction = std::max(progress.fraction, latest_.progress.fraction);
    latest_.progress = std::move(progress);
    ++latest_.progress_number;
    told = living_observers();
  }
  for (const auto& observer : told) observer->changed();
}

ProgressChannel::Latest ProgressChannel::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

void ProgressChannel::observe(const std::weak_ptr<ProgressObserver>& observer) {
  const std::lock_guard lock(mutex_);
  std::erase_if(observers_, [](const auto& weak) { return weak.expired(); });
  observers_.push_back(observer);
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
