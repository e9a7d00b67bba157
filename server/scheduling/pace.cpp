#include "server/scheduling/pace.h"

namespace tribodyn::server {
namespace {

constexpr std::uint64_t kEnoughJobs = 16;       // for a measurement
constexpr std::chrono::seconds kEnoughTime{1};  // with at least one job
constexpr double kShareOfNewMeasurement = 0.5;  // the others weigh half as much each time

}  // namespace

double Pace::seconds_per_job(std::uint64_t left, Time now) {
  const auto gap = now - last_;
  last_ = now;
  if (begin_ == Time() || gap > kLongestGap) {
    begin_ = now;
    left_before_ = left;
    return seconds_;
  }
  const std::uint64_t jobs = left - left_before_;
  const auto time = now - begin_;
  if (jobs == 0 || (jobs < kEnoughJobs && time < kEnoughTime)) return seconds_;
  const double measured = std::chrono::duration<double>(time).count() / static_cast<double>(jobs);
  seconds_ = seconds_ == 0 ? measured : seconds_ + kShareOfNewMeasurement * (measured - seconds_);
  begin_ = now;
  left_before_ = left;
  return seconds_;
}

}  // namespace tribodyn::server
