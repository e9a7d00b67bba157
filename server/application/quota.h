#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace tribodyn::server {

/// What one principal, or all principals together in one project, may take. 0: no limit but the
/// server's own.
struct Quota {
  double calls_per_second = 0;  ///< on average; kBurstSeconds of calls may come at once
  int streams = 0;              ///< open at a time
  double processor_hours = 0;   ///< estimated, of the simulations that wait and run
};

/// What has been taken of a quota: a token bucket of calls, open streams, and processor time of
/// work that is about to be queued. Safe for concurrent access.
class Allowance {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// The bucket holds the calls of so many seconds, and one at least.
  static constexpr double kBurstSeconds = 5;

  /// Takes a call. Returns 0, or takes none and returns the time until one is there [s].
  double take_call(double calls_per_second, Time now);

  /// Takes a stream. Returns false, and takes none, if `most` are open.
  bool open_stream(int most);
  void close_stream();

  /// Reserves `seconds` of a processor until the returned place is destroyed. The caller destroys
  /// the place once the work is written, and before this object. `unfinished` returns the time that
  /// written work still takes [s]. Returns null, and reserves nothing, if all together would exceed
  /// `most`.
  std::shared_ptr<void> reserve(double seconds, double most,
                                const std::function<double()>& unfinished);

 private:
  std::mutex mutex_;
  bool has_begun_ = false;  // guarded by mutex_, as all below
  double calls_ = 0;
  Time filled_;
  int streams_ = 0;
  double reserved_seconds_ = 0;
};

/// The quota of each project, and what has been taken of it. Safe for concurrent access.
class ProjectQuotas {
 public:
  explicit ProjectQuotas(const Quota& quota = {}) : quota_(quota) {}
  const Quota& quota() const { return quota_; }
  /// Returns the allowance of a project. Requires that the project exists: the object keeps an
  /// allowance for each name.
  std::shared_ptr<Allowance> of(const std::string& project);

 private:
  const Quota quota_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Allowance>> allowances_;  // guarded by mutex_
};

}  // namespace tribodyn::server
