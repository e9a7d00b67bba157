#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace tribodyn::server {

/// Tells those who were turned away when to ask again: the requests of a principal one after
/// another, as fast as they can be worked through, so that they do not all come back at once. Each
/// call takes a time that grows with the logarithm of kMostKept at most. Not safe for concurrent
/// access.
class Turns {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Returns when the next request of the principal may come: in `least_seconds`, or after those
  /// that were turned away before it, but never sooner than kLeastSeconds and never later than
  /// kMostSeconds [s]. The request occupies the processors for `work_seconds`.
  double next(const std::string& principal, double least_seconds, double work_seconds, Time now);

  std::size_t size() const { return turns_.size(); }

  /// A round trip and a commit take some milliseconds; sooner is not worth asking.
  static constexpr double kLeastSeconds = 0.02;
  static constexpr double kMostSeconds = 600;
  /// Principals that are remembered; of more, those whose turn comes first are forgotten.
  static constexpr std::size_t kMostKept = 4096;

 private:
  std::map<std::string, Time> turns_;
  std::set<std::pair<Time, std::string>> by_time_;
};

}  // namespace tribodyn::server
