#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <utility>

#include "server/application/campaign_messages.h"
#include "server/application/campaigns.h"
#include "server/application/errors.h"

namespace tribodyn::server {
namespace {

/// Returns a number that differs between any two states of a campaign: the numbers of candidates
/// and rows only grow, and while they are equal only the state changes, or whether it is stalled.
/// Below 2^53, which JavaScript keeps exactly: of 25 bits for points, 25 for those that are done
/// and 3 for the state.
std::int64_t version_of(const CampaignProgress& progress, bool is_stalled) {
  constexpr std::int64_t kStates = 8, kStalled = 7, kPoints = std::int64_t{1} << 25;
  return (progress.points * kPoints + progress.points_done) * kStates +
         (is_stalled ? kStalled : static_cast<std::int64_t>(progress.state));
}

/// How far one campaign is. Holds nothing but the present state, so that a slow reader costs no
/// memory and a campaign of thousands of tiles leaves no events behind.
class CampaignWatch final : public MessageSource<v1::CampaignEvent> {
 public:
  CampaignWatch(Application& application, const StoredCampaign& campaign, std::int64_t after,
                const CallContext& call)
      : store_(application.store),
        jobs_(application.jobs),
        limits_{.cancelled = call.limits.cancelled},
        campaign_(campaign.id),
        name_(name_of(campaign)),
        told_version_(after) {}

  void observe(const std::weak_ptr<Observer>& observer) override {
    store_.observe_campaigns(observer);
    jobs_.scheduler().wake(observer);
  }
  bool follows_changes() const override { return true; }

  Step next(v1::CampaignEvent& out) override {
    if (is_over_) return Step::kEnd;
    // A heartbeat also finds changes that nothing announced, such as the removal of an old
    // campaign.
    const bool is_quiet = Steady::now() - last_message_ >= jobs_.heartbeat();
    if (store_.campaign_changes() == seen_changes_ && !is_quiet) return Step::kWait;
    seen_changes_ = store_.campaign_changes();  // before the state is read
    const auto progress = store_.campaign_progress(campaign_, first_missing_row_, limits_);
    out.Clear();
    out.set_name(name_);
    if (!progress) {
      is_over_ = true;
      out.set_kind(v1::CampaignEvent::DELETED);
      return Step::kMessage;
    }
    is_over_ = has_ended(progress->state);
    first_missing_row_ = progress->first_missing_row;
    const auto stalled = stall_of(jobs_.campaigns(), campaign_);
    const std::int64_t version = version_of(*progress, stalled.has_value());
    if (version == told_version_ && !is_quiet) return is_over_ ? Step::kEnd : Step::kWait;
    out.set_kind(kind_of(*progress, stalled.has_value(), version));
    fill(*progress, version, out);
    if (stalled) *out.mutable_stalled() = *stalled;
    told_version_ = version;
    told_state_ = progress->state;
    told_stalled_ = stalled.has_value();
    last_message_ = Steady::now();
    return Step::kMessage;
  }

  bool is_short() const override { return true; }
  bool may_continue() const override {
    return is_over_ || store_.campaign_changes() != seen_changes_;
  }

 private:
  using Steady = std::chrono::steady_clock;

  v1::CampaignEvent::Kind kind_of(const CampaignProgress& progress, bool is_stalled,
                                  std::int64_t version) const {
    if (version == told_version_) return v1::CampaignEvent::HEARTBEAT;
    return told_state_ == progress.state && told_stalled_ == is_stalled
               ? v1::CampaignEvent::PROGRESS
               : v1::CampaignEvent::STATE_CHANGE;
  }

  static void fill(const CampaignProgress& progress, std::int64_t version, v1::CampaignEvent& out) {
    out.set_state(static_cast<v1::Campaign::State>(progress.state));
    if (!progress.stop_reason.empty()) {
      out.mutable_stop()->set_reason(progress.stop_reason);
      out.mutable_stop()->set_message(progress.stop_message);
    }
    out.set_points(static_cast<int>(progress.points));
    out.set_points_done(static_cast<int>(progress.points_done));
    out.set_points_refused(static_cast<int>(progress.points_refused));
    out.set_first_missing_row(static_cast<int>(progress.first_missing_row));
    out.set_processor_seconds(progress.processor_seconds);
    out.set_version(version);
  }

  Store& store_;
  SimulationJobs& jobs_;
  const CallLimits limits_;  // the end of the stream is its transport's
  const std::int64_t campaign_;
  const std::string name_;
  std::int64_t told_version_;
  std::optional<CampaignState> told_state_;  // empty before the first event
  bool told_stalled_ = false;
  std::int64_t first_missing_row_ = 0;
  std::uint64_t seen_changes_ = 0;  // Store::campaign_changes() before the last read
  bool is_over_ = false;
  Steady::time_point last_message_ = Steady::now();
};

}  // namespace

StreamOutcome<v1::CampaignEvent> watch_campaign(Application& application,
                                                const v1::WatchCampaignRequest& request,
                                                const CallContext& call) {
  using Source = std::shared_ptr<MessageSource<v1::CampaignEvent>>;
  if (request.after_version() < 0) {
    return invalid({{"after_version", fmt::format("after_version = {}; allowed: 0 or more",
                                                  request.after_version())}});
  }
  const auto found = find_campaign(application, request.name(), call);
  if (!found.ok()) return found.error();
  return Source(
      std::make_shared<CampaignWatch>(application, found.message(), request.after_version(), call));
}

}  // namespace tribodyn::server
