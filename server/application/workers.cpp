#include "server/application/workers.h"

#include <utility>

namespace tribodyn::server {
namespace {

constexpr std::size_t kShareOfOthers = 8;

}  // namespace

Workers::Workers(int threads, std::size_t waiting, std::size_t bytes)
    : most_waiting_(waiting), most_bytes_(bytes) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool Workers::run(std::size_t bytes, std::function<void()>& task, const std::string& principal) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = tasks_.find(principal);
    const std::size_t own = found == tasks_.end() ? 0 : found->second.size();
    const bool has_place = load_.waiting < most_waiting_ || (load_.waiting < 2 * most_waiting_ &&
                                                             own < most_waiting_ / kShareOfOthers);
    if (!has_place || bytes > most_bytes_ - bytes_) return false;
    bytes_ += bytes;
    ++load_.waiting;
    std::deque<Task>& tasks = tasks_[principal];
    if (tasks.empty()) turns_.push_back(principal);
    tasks.push_back({bytes, std::move(task)});
  }
  changed_.notify_one();
  return true;
}

Workers::Load Workers::load() {
  const std::lock_guard lock(mutex_);
  return load_;
}

Workers::Task Workers::next() {
  std::string principal = std::move(turns_.front());
  turns_.pop_front();
  const auto found = tasks_.find(principal);
  Task out = std::move(found->second.front());
  found->second.pop_front();
  --load_.waiting;
  if (found->second.empty()) {
    tasks_.erase(found);
  } else {
    turns_.push_back(std::move(principal));
  }
  return out;
}

void Workers::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || load_.waiting > 0; });
    if (load_.waiting == 0) return;
    const Task task = next();
    ++load_.running;
    lock.unlock();
    task.run();
    lock.lock();
    --load_.running;
    bytes_ -= task.bytes;
  }
}

}  // namespace tribodyn::server
