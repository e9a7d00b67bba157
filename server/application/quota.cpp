#include "server/application/quota.h"

#include <algorithm>

namespace tribodyn::server {

double Allowance::take_call(double calls_per_second, Time now) {
  const double most = std::max(1.0, kBurstSeconds * calls_per_second);
  const std::lock_guard lock(mutex_);
  if (!has_begun_) calls_ = most;
  if (has_begun_ && now > filled_) {
    const double seconds = std::chrono::duration<double>(now - filled_).count();
    calls_ = std::min(most, calls_ + seconds * calls_per_second);
  }
  if (!has_begun_ || now > filled_) filled_ = now;
  has_begun_ = true;
  if (calls_ < 1) return (1 - calls_) / calls_per_second;
  calls_ -= 1;
  return 0;
}

bool Allowance::open_stream(int most) {
  const std::lock_guard lock(mutex_);
  if (streams_ >= most) return false;
  ++streams_;
  return true;
}

void Allowance::close_stream() {
  const std::lock_guard lock(mutex_);
  --streams_;
}

std::shared_ptr<void> Allowance::reserve(double seconds, double most,
                                         const std::function<double()>& unfinished) {
  const std::lock_guard lock(mutex_);
  // Work that is written before its place is returned counts twice until then. No work is left out.
  if (unfinished() + reserved_seconds_ + seconds > most) return nullptr;
  reserved_seconds_ += seconds;
  return std::shared_ptr<void>(this, [this, seconds](void*) {
    const std::lock_guard inner(mutex_);
    reserved_seconds_ -= seconds;
  });
}

std::shared_ptr<Allowance> ProjectQuotas::of(const std::string& project) {
  const std::lock_guard lock(mutex_);
  auto& out = allowances_[project];
  if (out == nullptr) out = std::make_shared<Allowance>();
  return out;
}

}  // namespace tribodyn::server
