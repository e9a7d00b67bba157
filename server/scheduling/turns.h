#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace tribodyn::server {

/// Computes retry delays for refused requests. The requests of one principal get successive times
/// at the rate at which the server computes them (pace.h), so that they do not all return at once;
/// those of a time slot return together, so that one commit can store several of them.
/// Each call takes a time that grows with the logarithm of kMostKept at most. Not safe for
/// concurrent access.
class Turns {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Limits of the delays of refused requests, and length of a slot [s].
  struct Delays {
    double least;
    double most;
    double slot = 0;  ///< a delay ends at a multiple of it; 0: at any time
  };

  /// Returns the delay of the principal's next request [s]: the least one, or longer, until after
  /// its requests that were refused before; kLeastSeconds to kMostSeconds, then up to the end of a
  /// slot. The request will occupy the server for `work_seconds`. What would exceed the most begins
  /// at the least again: requests then come more than once, but the server has work even if it
  /// becomes faster meanwhile.
  double next(const std::string& principal, const Delays& delays, double work_seconds, Time now);

  std::size_t size() const { return turns_.size(); }

  /// Shortest delay [s]. A round trip and a commit take some milliseconds.
  static constexpr double kLeastSeconds = 0.02;
  static constexpr double kMostSeconds = 600;
  /// Largest number of principals whose turn is remembered. Beyond it the earliest turns are
  /// forgotten.
  static constexpr std::size_t kMostKept = 4096;

 private:
  std::map<std::string, Time> turns_;
  std::set<std::pair<Time, std::string>> by_time_;
};

}  // namespace tribodyn::server
