#include "server/application/workers.h"

#include <utility>

namespace tribodyn::server {

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

bool Workers::run(std::size_t bytes, std::function<void()>& task) {
  {
    const std::lock_guard lock(mutex_);
    if (tasks_.size() >= most_waiting_ || bytes > most_bytes_ - bytes_) return false;
    bytes_ += bytes;
    tasks_.push_back({bytes, std::move(task)});
  }
  changed_.notify_one();
  return true;
}

bool Workers::is_empty() {
  const std::lock_guard lock(mutex_);
  return tasks_.empty();
}

void Workers::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
    if (tasks_.empty()) return;
    const Task task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task.run();
    lock.lock();
    bytes_ -= task.bytes;
  }
}

}  // namespace tribodyn::server
