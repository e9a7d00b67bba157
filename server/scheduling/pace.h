#pragma once

#include <chrono>
#include <cstdint>

namespace tribodyn::server {

/// Measures the mean time between jobs that leave a full queue: what a job takes on all processors,
/// with its calls and commits and whatever else the machine does. Not safe for concurrent access.
class Pace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Takes note of the number of jobs that have left so far; to be called whenever a request finds
  /// no place. Returns the mean time between two of them [s]; 0 until it is known.
  double seconds_per_job(std::uint64_t left, Time now);

  /// Returns the number of jobs that have left since the pace last changed by a factor of two.
  std::uint64_t steady_jobs() const { return steady_jobs_; }

  /// Without a call for so long the queue may have had places, and a new measurement begins.
  static constexpr std::chrono::seconds kLongestGap{2};

 private:
  void begin_steady(std::uint64_t left, Time now);

  Time begin_;                     // of the present measurement
  Time last_;                      // call
  std::uint64_t left_before_ = 0;  // at begin_
  double seconds_ = 0;
  Time steady_begin_;              // of the period of about the present pace
  std::uint64_t steady_left_ = 0;  // at steady_begin_
  std::uint64_t steady_jobs_ = 0;  // since then, at the last measurement
};

}  // namespace tribodyn::server
