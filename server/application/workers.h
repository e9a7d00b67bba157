#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tribodyn::server {

/// Threads that run tasks in the order of their arrival, and a queue of limited length. Safe for
/// concurrent access; the destructor runs what was accepted.
class Workers {
 public:
  /// At most `waiting` tasks wait; tasks of at most `bytes` wait or are under way.
  Workers(int threads, std::size_t waiting, std::size_t bytes);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Returns false, and leaves `task` as it is, if the queue is full.
  bool run(std::size_t bytes, std::function<void()>& task);

 private:
  struct Task {
    std::size_t bytes;
    std::function<void()> run;
  };
  void work();

  const std::size_t most_waiting_;
  const std::size_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> tasks_;  // guarded by mutex_
  std::size_t bytes_ = 0;   // guarded by mutex_; of tasks that wait or are under way
  bool stopping_ = false;   // guarded by mutex_
  std::vector<std::thread> threads_;
};

}  // namespace tribodyn::server
