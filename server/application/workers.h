#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tribodyn::server {

/// Threads that run tasks, and a queue of limited length. Principals take turns, a task each; those
/// of one principal run in the order of their arrival. Safe for concurrent access. The destructor
/// runs the accepted tasks.
class Workers {
 public:
  /// At most `waiting` tasks wait. When one principal has taken these places, others still have an
  /// eighth of that number each, together as many again. Tasks that wait or run have at most
  /// `bytes` together.
  Workers(int threads, std::size_t waiting, std::size_t bytes);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Queues a task. Returns false, and does not change `task`, if the queue is full.
  bool run(std::size_t bytes, std::function<void()>& task, const std::string& principal = {});
  /// Returns true if no task waits.
  bool is_empty() { return load().waiting == 0; }
  /// Number of tasks that wait, and that a thread runs.
  struct Load {
    std::size_t waiting = 0;
    std::size_t running = 0;
  };
  Load load();

 private:
  struct Task {
    std::size_t bytes;
    std::function<void()> run;
  };
  void work();
  /// Removes and returns the task whose turn it is. Requires one that waits.
  Task next();

  const std::size_t most_waiting_;
  const std::size_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, std::deque<Task>> tasks_;  // guarded by mutex_; by principal, none empty
  std::deque<std::string> turns_;                  // guarded by mutex_; the keys of tasks_
  Load load_;                                      // guarded by mutex_
  std::size_t bytes_ = 0;                          // guarded by mutex_; of tasks that wait or run
  bool stopping_ = false;                          // guarded by mutex_
  std::vector<std::thread> threads_;
};

}  // namespace tribodyn::server
