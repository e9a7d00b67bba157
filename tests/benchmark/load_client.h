#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace tribodyn {

/// Starts one request and calls `done` when it has ended, on any thread.
using StartRequest = std::function<void(int number, std::function<void(bool ok)> done)>;

/// How long requests took, and how many failed.
struct Latencies {
  std::vector<double> seconds = {};  ///< ascending
  int failures = 0;
  double percentile(double share) const;  ///< e.g. 0.99 [s]
};

/// An open loop: requests start when they are due, whether earlier ones have ended or not, and
/// their time counts from then, so that a server that stalls is seen to.
Latencies open_loop(double requests_per_second, std::chrono::duration<double> time,
                    const StartRequest& start);

/// A closed loop: so many requests are under way all the time, until `count` have ended.
Latencies closed_loop(int under_way, int count, const StartRequest& start);

/// What the system says of a process.
struct ProcessFigures {
  double resident_bytes = 0;     ///< the sum of the next three
  double anonymous_bytes = 0;    ///< heaps and stacks
  double file_bytes = 0;         ///< mapped files: the program and its libraries
  double shared_bytes = 0;       ///< mapped memory that processes may share
  double processor_seconds = 0;  ///< of all its threads since it began
  int threads = 0;
  int descriptors = 0;
};
ProcessFigures process_figures(int process_id);

/// The process that holds a database, by its lock file.
int server_of(const std::string& database);

/// The most memory that a process comes to beyond what it had, while `action` runs [bytes].
double memory_growth(int process_id, const std::function<void()>& action);

}  // namespace tribodyn
