#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace tribodyn::server {

/// A job up to this estimate is interactive unless its request states otherwise: somebody is
/// looking at it [s].
inline constexpr double kInteractiveSeconds = 1;

/// What a request states of its urgency; the numbers are those of SchedulingClass on the wire.
enum class StatedClass { kAutomatic = 0, kInteractive = 1, kBulk = 2 };

/// Where a waiting job stands, most urgent first.
enum class Lane {
  kStated,  ///< stated INTERACTIVE
  kSmall,   ///< not stated, and its estimate is at most kInteractiveSeconds
  kBulk,
};

/// A job that waits.
struct QueuedJob {
  std::int64_t id = 0;
  std::string principal = {};  ///< whose share of the processors pays for it
  double cost_seconds = 0;     ///< estimated, of one processor
  bool alone = false;          ///< may be what killed the server: nothing runs beside it
  StatedClass stated = StatedClass::kAutomatic;
  std::int64_t result_bytes = 0;  ///< of the history that it will have
  Lane lane() const {
    if (stated == StatedClass::kInteractive) return Lane::kStated;
    const bool is_small = stated == StatedClass::kAutomatic && cost_seconds <= kInteractiveSeconds;
    return is_small ? Lane::kSmall : Lane::kBulk;
  }
  bool is_interactive() const { return lane() != Lane::kBulk; }
};

/// Decides who comes next. Between principals the one who has been served least (start-time fair
/// queueing: who comes back has no credit for the time away, and still owes what was used beyond
/// the estimates). Of one principal the jobs stated INTERACTIVE, and after these the job whose
/// estimate, added to what the principal had been served when it came, is least: small ones first,
/// and large ones after as much other work as they are large. Each call takes a time that grows
/// with the logarithm of what waits. Not safe for concurrent access.
class FairQueue {
 public:
  void push(const QueuedJob& job);
  /// Takes out the next job of the lanes up to `last`; returns nullopt if none waits there.
  std::optional<QueuedJob> pop(Lane last);
  /// As pop, but leaves the job where it is.
  const QueuedJob* peek(Lane last) const;
  bool erase(std::int64_t id);
  bool contains(std::int64_t id) const { return places_.contains(id); }
  /// Adds `seconds`, which may be negative, to what the principal has been served.
  void charge(const std::string& principal, double seconds);

  std::size_t size() const { return places_.size(); }
  double cost_seconds() const { return cost_seconds_; }
  std::size_t size_of(const std::string& principal) const;
  double cost_seconds_of(const std::string& principal) const;

  /// Principals that are remembered though nothing of theirs waits, because they have been served
  /// more than others; those that owe least are forgotten first.
  static constexpr std::size_t kMostDebtors = 4096;
  std::size_t debtors() const { return debts_.size(); }

 private:
  static constexpr int kLanes = 3;
  /// Rank, then order of arrival.
  using Place = std::pair<double, std::int64_t>;
  using Jobs = std::map<Place, QueuedJob>;
  /// What the principal has been served, arrival of the next job, principal.
  using Turn = std::tuple<double, std::int64_t, std::string>;
  struct Principal {
    double served_seconds = 0;  ///< virtual time
    double cost_seconds = 0;    ///< of what waits
    std::array<Jobs, kLanes> lanes;
    std::array<std::optional<Turn>, kLanes> turns;  ///< the entries in turns_
    std::size_t size() const { return lanes[0].size() + lanes[1].size() + lanes[2].size(); }
  };
  using Principals = std::map<std::string, Principal>;

  static const Jobs::value_type* first_of(const Principal& principal, Lane last);
  void set_turns(Principals::iterator principal);
  void remove(Principals::iterator principal, const Place& place, Lane lane);
  void remember(const std::string& principal, double served_seconds);
  double take_debt(const std::string& principal);
  void forgive();

  Principals principals_;  // those with jobs
  std::map<std::int64_t, std::tuple<std::string, Place, Lane>> places_;
  std::array<std::set<Turn>, kLanes> turns_;  // by last lane: who comes next
  double cost_seconds_ = 0;
  double now_ = 0;  // virtual time: what the principal who came last had been served before
  std::int64_t arrivals_ = 0;
  std::map<std::string, double> debts_;  // served_seconds of those without jobs, beyond now_
  std::set<std::pair<double, std::string>> debts_by_size_;
};

}  // namespace tribodyn::server
