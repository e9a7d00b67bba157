#include "server/application/campaign_messages.h"

#include <fmt/format.h>

#include "server/application/errors.h"
#include "server/application/stored_messages.h"

namespace tribodyn::server {
namespace {

static_assert(static_cast<int>(CampaignState::kRunning) == v1::Campaign::RUNNING);
static_assert(static_cast<int>(CampaignState::kPaused) == v1::Campaign::PAUSED);
static_assert(static_cast<int>(CampaignState::kSucceeded) == v1::Campaign::SUCCEEDED);
static_assert(static_cast<int>(CampaignState::kFailed) == v1::Campaign::FAILED);
static_assert(static_cast<int>(CampaignState::kCancelled) == v1::Campaign::CANCELLED);

}  // namespace

v1::Campaign to_message(Application& application, const StoredCampaign& stored) {
  v1::Campaign out;
  out.ParseFromString(stored.request);
  out.set_name(name_of(stored));
  out.set_state(static_cast<v1::Campaign::State>(stored.state));
  if (!stored.stop_reason.empty()) {
    out.mutable_stop()->set_reason(stored.stop_reason);
    out.mutable_stop()->set_message(stored.stop_message);
  }
  out.clear_budget();
  if (stored.budget.processor_seconds > 0 || stored.budget.points > 0) {
    out.mutable_budget()->set_processor_seconds(stored.budget.processor_seconds);
    out.mutable_budget()->set_points(static_cast<int>(stored.budget.points));
  }
  out.set_candidates(stored.candidates);
  out.set_points(static_cast<int>(stored.points()));
  out.set_points_done(static_cast<int>(stored.points_done));
  out.set_points_refused(static_cast<int>(stored.points_refused));
  out.set_processor_seconds(stored.processor_seconds);
  *out.mutable_create_time() = timestamp_of(stored.create_time);
  if (stored.end_time) {
    *out.mutable_end_time() = timestamp_of(*stored.end_time);
    if (const auto& keep = application.jobs.retention().keep) {
      *out.mutable_expire_time() = timestamp_of(*stored.end_time + *keep);
    }
  }
  set_revisions(stored.revisions, out);
  out.set_input_hash(stored.input_hash);
  out.set_model_version(stored.model_version);
  out.set_request_id(stored.request_id);
  out.set_stored_bytes(stored.stored_bytes);
  if (const auto stalled = stall_of(application.jobs.campaigns(), stored.id))
    *out.mutable_stalled() = *stalled;
  return out;
}

std::optional<v1::CampaignStop> stall_of(CampaignJobs& campaigns, std::int64_t campaign) {
  const auto cause = campaigns.stalled(campaign);
  if (!cause) return std::nullopt;
  const google::rpc::Status error = store_failed(*cause);
  v1::CampaignStop out;
  out.set_reason(reason_text(reason_of(error)));
  out.set_message(error.message() + "; the campaign continues by itself once it can be written");
  return out;
}

CampaignBudget to_budget(const v1::CampaignBudget& budget) {
  return {budget.processor_seconds(), budget.points()};
}

google::rpc::Status no_campaign(const std::string& name) {
  return not_found(kCampaignType, name, name + " does not exist");
}

google::rpc::Status campaign_turned_away(Application& application) {
  constexpr double kRetrySeconds = 60;  // campaigns take seconds to hours
  if (application.jobs.scheduler().is_stopping()) return shutting_down();
  return exhausted(v1::ERROR_REASON_TOO_MANY_WAITING,
                   fmt::format("too many campaigns run, or their candidates take too much memory; "
                               "try again in {:g} s",
                               kRetrySeconds),
                   kRetrySeconds);
}

}  // namespace tribodyn::server
