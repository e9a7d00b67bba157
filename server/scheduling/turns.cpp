#include "server/scheduling/turns.h"

#include <algorithm>
#include <cmath>

namespace tribodyn::server {

double Turns::next(const std::string& principal, const Delays& delays, double work_seconds,
                   Time now) {
  using std::chrono::duration;
  const double least = std::clamp(delays.least, kLeastSeconds, kMostSeconds);
  const double most = std::clamp(delays.most, least, kMostSeconds);
  double seconds = least;
  const auto found = turns_.find(principal);
  if (found != turns_.end()) {
    seconds = std::max(seconds, duration<double>(found->second - now).count());
    by_time_.erase({found->second, principal});
    turns_.erase(found);
  }
  if (seconds > most) seconds = least;
  const Time turn =
      now + std::chrono::duration_cast<Time::duration>(duration<double>(seconds + work_seconds));
  turns_.emplace(principal, turn);
  by_time_.emplace(turn, principal);
  while (!by_time_.empty() && (by_time_.begin()->first < now || by_time_.size() > kMostKept)) {
    turns_.erase(by_time_.begin()->second);
    by_time_.erase(by_time_.begin());
  }
  if (delays.slot <= 0) return seconds;
  const double end = duration<double>(now.time_since_epoch()).count() + seconds;
  return seconds + std::ceil(end / delays.slot) * delays.slot - end;
}

}  // namespace tribodyn::server
