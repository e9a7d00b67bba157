#include "server/scheduling/pace.h"

namespace tribodyn::server {
namespace {

constexpr std::uint64_t kEnoughJobs = 16;       // for a measurement
constexpr std::chrono::seconds kEnoughTime{1};  // with at least one job
constexpr double kShareOfNewMeasurement = 0.5;  // the others weigh half as much each time
/// Ratio of the present pace to the mean of the steady period, or its inverse, at which a new
/// period begins. Not fitted: larger than the scatter of measurements of few jobs, which leave in
/// groups, and smaller than the fivefold change in the tests.
constexpr double kChangedPace = 2;

}  // namespace

double Pace::seconds_per_job(std::uint64_t left, Time now) {
  const auto gap = now - last_;
  last_ = now;
  if (begin_ == Time() || gap > kLongestGap) {
    begin_ = now;
    left_before_ = left;
    begin_steady(left, now);
    return seconds_;
  }
  const std::uint64_t jobs = left - left_before_;
  const auto time = now - begin_;
  if (jobs == 0 || (jobs < kEnoughJobs && time < kEnoughTime)) return seconds_;
  const double measured = std::chrono::duration<double>(time).count() / static_cast<double>(jobs);
  seconds_ = seconds_ == 0 ? measured : seconds_ + kShareOfNewMeasurement * (measured - seconds_);
  begin_ = now;
  left_before_ = left;
  steady_jobs_ = left - steady_left_;
  const double steady = std::chrono::duration<double>(now - steady_begin_).count() /
                        static_cast<double>(steady_jobs_);
  if (seconds_ > kChangedPace * steady || steady > kChangedPace * seconds_) begin_steady(left, now);
  return seconds_;
}

void Pace::begin_steady(std::uint64_t left, Time now) {
  steady_begin_ = now;
  steady_left_ = left;
  steady_jobs_ = 0;
}

}  // namespace tribodyn::server
