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

/// Largest estimate of a small job, in seconds of one processor. A person waits for so long without
/// turning to something else, so small jobs begin before large ones.
inline constexpr double kSmallJobSeconds = 1;

/// The class that a request asks for. The numbers are those of v1::SchedulingClass.
enum class RequestedClass { kAutomatic = 0, kInteractive = 1, kBulk = 2 };

/// How soon a waiting job should begin, most urgent first.
enum class Urgency {
  kInteractive,  ///< its request asks for INTERACTIVE
  kSmall,        ///< its request asks for no class; its estimate is at most kSmallJobSeconds
  kBulk,         ///< all others
};

/// Service of its principal for which a slice of a campaign waits behind small jobs [s].
inline constexpr double kSlicePatienceSeconds = 60;

/// Largest number of threads that compute one campaign at a time.
inline constexpr int kMostCampaignParts = 256;

/// Returns the id of a part of a campaign in the queue. Those of simulations are positive.
constexpr std::int64_t campaign_part_id(std::int64_t campaign, int part) {
  return -(campaign * kMostCampaignParts + part);
}
/// A part of a campaign: one of the threads that may compute it. Parts count from 0.
struct CampaignPart {
  std::int64_t campaign = 0;  ///< row
  int part = 0;
};
/// Returns the part with this id; nullopt for the id of a simulation.
constexpr std::optional<CampaignPart> campaign_part(std::int64_t id) {
  if (id >= 0) return std::nullopt;
  return CampaignPart{-id / kMostCampaignParts, static_cast<int>(-id % kMostCampaignParts)};
}

/// A job that waits.
struct QueuedJob {
  std::int64_t id = 0;         ///< row of a simulation, or campaign_part_id()
  std::string principal = {};  ///< whose share of the processors pays for it
  double cost_seconds = 0;     ///< estimate, in seconds of one processor
  bool alone = false;          ///< may have killed the server, so no other job runs beside it
  RequestedClass requested = RequestedClass::kAutomatic;
  std::int64_t result_bytes = 0;  ///< size of its history
  Urgency urgency() const {
    if (requested == RequestedClass::kInteractive) return Urgency::kInteractive;
    const bool is_small =
        requested == RequestedClass::kAutomatic && cost_seconds <= kSmallJobSeconds;
    return is_small ? Urgency::kSmall : Urgency::kBulk;
  }
};

/// Orders the waiting jobs. The next job belongs to the principal that has been served least
/// (start-time fair queueing: a principal that returns gets no credit for the time when it was
/// away, and still owes what its jobs used beyond their estimates). Of one principal, interactive
/// jobs come first. The other jobs follow in the order of their estimate plus the service that the
/// principal had received when the job arrived: a large job waits for as much other work as its own
/// estimate. A slice of a campaign also waits for small jobs that arrived later, so that a person
/// does not wait behind the campaigns of the same principal, but for kSlicePatienceSeconds of
/// service at most. Each call takes a time that grows with the logarithm of the number of waiting
/// jobs. Not safe for concurrent access.
class FairQueue {
 public:
  void push(const QueuedJob& job);
  /// Removes and returns the next job that is at least as urgent as `least`; nullopt if there is
  /// none.
  std::optional<QueuedJob> pop(Urgency least);
  /// Returns the job that pop() would return, or null, and leaves it in the queue.
  const QueuedJob* peek(Urgency least) const;
  bool erase(std::int64_t id);
  bool contains(std::int64_t id) const { return places_.contains(id); }
  /// Adds `seconds`, which may be negative, to the service that the principal has received.
  void charge(const std::string& principal, double seconds);

  std::size_t size() const { return places_.size(); }
  double cost_seconds() const { return cost_seconds_; }
  /// The same of simulations alone, without the parts of campaigns.
  std::size_t simulations() const { return simulations_.size; }
  double simulation_seconds() const { return simulations_.cost_seconds; }
  std::size_t size_of(const std::string& principal) const;
  double cost_seconds_of(const std::string& principal) const;

  /// Largest number of principals without waiting jobs whose debt the queue remembers. Beyond it
  /// the queue forgets the smallest debts.
  static constexpr std::size_t kMostDebtors = 4096;
  std::size_t debtors() const { return debts_.size(); }

 private:
  static constexpr int kUrgencies = 3;
  static constexpr int kSlices = kUrgencies;  // slices of campaigns, apart from other small jobs
  /// Rank, then order of arrival.
  using Place = std::pair<double, std::int64_t>;
  using Jobs = std::map<Place, QueuedJob>;
  /// Service that the principal has received, arrival number of its next job, principal.
  using Turn = std::tuple<double, std::int64_t, std::string>;
  struct Principal {
    double served_seconds = 0;                          ///< virtual time
    double cost_seconds = 0;                            ///< estimate of its waiting jobs
    std::array<Jobs, kUrgencies + 1> groups;            ///< by urgency; kSlices
    std::array<std::optional<Turn>, kUrgencies> turns;  ///< the entries in turns_
    std::size_t size() const {
      return groups[0].size() + groups[1].size() + groups[2].size() + groups[kSlices].size();
    }
  };
  using Principals = std::map<std::string, Principal>;

  static std::size_t group_of(const QueuedJob& job);
  static const Jobs::value_type* first_of(const Principal& principal, Urgency least);
  void set_turns(Principals::iterator principal);
  void remove(Principals::iterator principal, const Place& place, std::size_t group);
  void remember(const std::string& principal, double served_seconds);
  double take_debt(const std::string& principal);
  void forgive();

  Principals principals_;  // those with jobs
  std::map<std::int64_t, std::tuple<std::string, Place, std::size_t>> places_;
  std::array<std::set<Turn>, kUrgencies> turns_;  // by least urgency: which principal is next
  double cost_seconds_ = 0;
  struct {
    std::size_t size = 0;
    double cost_seconds = 0;
  } simulations_;
  double now_ = 0;  // virtual time: service of the principal of the latest job before that job
  std::int64_t arrivals_ = 0;
  std::map<std::string, double> debts_;  // served_seconds of those without jobs, beyond now_
  std::set<std::pair<double, std::string>> debts_by_size_;
};

}  // namespace tribodyn::server
