#include "server/application/campaigns.h"

#include <fmt/format.h>
#include <google/protobuf/util/message_differencer.h>
#include <google/protobuf/util/time_util.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>

#include "core/version.h"
#include "server/application/errors.h"
#include "server/application/page_token.h"
#include "server/application/paging.h"
#include "server/application/project_space.h"
#include "server/application/request_text.h"
#include "server/contract/check_message.h"
#include "server/contract/output_only.h"
#include "server/simulation/campaign_inputs.h"
#include "server/simulation/result_key.h"
#include "server/storage/resource_lookup.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

constexpr int kDefaultCampaignPage = 50;
constexpr int kCampaignDeletions = 10;  // attempts, against others that resume it
constexpr char kCampaignType[] = "tribodyn.v1.Campaign";

static_assert(static_cast<int>(CampaignState::kRunning) == v1::Campaign::RUNNING);
static_assert(static_cast<int>(CampaignState::kPaused) == v1::Campaign::PAUSED);
static_assert(static_cast<int>(CampaignState::kSucceeded) == v1::Campaign::SUCCEEDED);
static_assert(static_cast<int>(CampaignState::kFailed) == v1::Campaign::FAILED);
static_assert(static_cast<int>(CampaignState::kCancelled) == v1::Campaign::CANCELLED);

using google::protobuf::util::TimeUtil;

google::rpc::Status no_campaign(const std::string& name) {
  return not_found(kCampaignType, name, name + " does not exist");
}

CampaignBudget to_budget(const v1::CampaignBudget& budget) {
  return {budget.processor_seconds(), budget.points()};
}

void set_revisions(const NewCampaign& campaign, v1::Campaign& out) {
  out.set_lubricant_revision(campaign.lubricant_revision);
  out.set_gear_set_revision(campaign.gear_set_revision);
  out.set_surface_revision(campaign.surface_revision);
  out.set_vehicle_revision(campaign.vehicle_revision);
}

/// Returns the stored campaign as a message, without what only GetCampaign answers.
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
  *out.mutable_create_time() = TimeUtil::MicrosecondsToTimestamp(stored.create_time);
  if (stored.end_time) {
    *out.mutable_end_time() = TimeUtil::MicrosecondsToTimestamp(*stored.end_time);
    if (const auto& keep = application.jobs.retention().keep) {
      *out.mutable_expire_time() = TimeUtil::MicrosecondsToTimestamp(*stored.end_time + *keep);
    }
  }
  out.set_lubricant_revision(stored.lubricant_revision);
  out.set_gear_set_revision(stored.gear_set_revision);
  out.set_surface_revision(stored.surface_revision);
  out.set_vehicle_revision(stored.vehicle_revision);
  out.set_input_hash(stored.input_hash);
  out.set_model_version(stored.model_version);
  out.set_request_id(stored.request_id);
  out.set_stored_bytes(stored.stored_bytes);
  return out;
}

/// Adds which rows are there, and the sentences of those without figures.
void add_rows_state(Application& application, const StoredCampaign& stored, const CallContext& call,
                    v1::Campaign& out) {
  std::int64_t missing = 0;
  for (const RowRange& tile : application.store.campaign_tiles(stored.id, call.limits)) {
    if (tile.first != missing) break;
    missing += tile.count;
  }
  out.set_first_missing_row(static_cast<int>(missing));
  for (const CampaignRefusal& each : application.store.campaign_refusals(stored.id, call.limits)) {
    while (out.refusals_size() < each.number) out.add_refusals();
    v1::PointRefusal& refusal = *out.mutable_refusals(each.number - 1);
    refusal.set_reason(each.reason);
    refusal.set_message(each.message);
  }
}

/// Returns the hash of everything that the client set.
std::string request_hash(const v1::Campaign& campaign) {
  return sha256(campaign.SerializeAsString());
}

google::rpc::Status campaign_request_id_taken(Application& application,
                                              const StoredCampaign& stored,
                                              const v1::CreateCampaignRequest& request,
                                              const v1::Campaign& stated, const CallContext& call) {
  v1::Campaign earlier;
  earlier.ParseFromString(stored.request);
  earlier.MergeFromString(application.store.candidate_table(stored.id, call.limits));
  std::string field = "none";
  const auto& type = *v1::Campaign::descriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    google::protobuf::util::MessageDifferencer differencer;
    if (differencer.CompareWithFields(earlier, stated, {type.field(i)}, {type.field(i)})) continue;
    field = "campaign." + type.field(i)->name();
    break;
  }
  return already_exists(
      v1::ERROR_REASON_REQUEST_ID_REUSED, kCampaignType, name_of(stored),
      fmt::format("request_id \"{}\" made {} by a request that differs in {}; take another one",
                  request.request_id(), name_of(stored), field),
      {{"request_id", request.request_id()}, {"field", field}},
      {{"request_id", fmt::format("belongs to another request; it differs in {}", field)}});
}

/// The answer to a request whose request_id made the stored campaign.
Outcome<v1::Campaign> repeated_answer(Application& application, const StoredCampaign& stored,
                                      const v1::CreateCampaignRequest& request,
                                      const v1::Campaign& stated, const CallContext& call) {
  if (stored.request_hash != request_hash(stated)) {
    return campaign_request_id_taken(application, stored, request, stated, call);
  }
  application.jobs.campaigns().ensure_queued(stored);
  return to_message(application, stored);
}

NewCampaign new_campaign(const v1::CreateCampaignRequest& request, const CampaignInputs& inputs,
                         const std::string& hash, const CallContext& call) {
  const v1::Simulation& effective = inputs.points.base.effective;
  NewCampaign out;
  out.project = call.project;
  out.request = inputs.requested.SerializeAsString();
  out.candidate_table = inputs.table.SerializeAsString();
  out.request_id = request.request_id();
  out.request_hash = hash;
  out.input_hash = inputs.input_hash;
  out.model_version = kModelVersion;
  out.platform = platform();
  out.client = call.client;
  out.principal = payer(call);
  out.candidates = inputs.points.candidates;
  out.conditions = inputs.points.conditions;
  out.cost_seconds = estimate_cost(inputs).processor_seconds();
  out.budget = to_budget(inputs.requested.budget());
  out.lubricant_revision = effective.lubricant_revision();
  out.gear_set_revision = effective.gear_set_revision();
  out.surface_revision = effective.surface_revision();
  out.vehicle_revision = effective.vehicle_revision();
  return out;
}

/// Returns the campaign that a request with validate_only would create, without a name.
v1::Campaign campaign_preview(const CampaignInputs& inputs, const NewCampaign& campaign) {
  v1::Campaign out = inputs.requested;
  set_revisions(campaign, out);
  out.set_state(v1::Campaign::RUNNING);
  out.set_candidates(campaign.candidates);
  out.set_points(campaign.candidates * campaign.conditions);
  out.set_input_hash(campaign.input_hash);
  out.set_model_version(campaign.model_version);
  *out.mutable_cost_estimate() = estimate_cost(inputs);
  return out;
}

google::rpc::Status campaign_turned_away(Application& application) {
  constexpr double kRetrySeconds = 60;  // campaigns take seconds to hours
  if (application.jobs.is_stopping()) return shutting_down();
  return exhausted(v1::ERROR_REASON_TOO_MANY_WAITING,
                   fmt::format("too many campaigns run, or their candidates take too much memory; "
                               "try again in {:g} s",
                               kRetrySeconds),
                   kRetrySeconds);
}

/// The answer to a request that changed a campaign's state.
Outcome<v1::Campaign> changed_answer(Application& application, const std::string& name,
                                     const std::optional<StoredCampaign>& stored) {
  if (!stored) return no_campaign(name);
  return to_message(application, *stored);
}

}  // namespace

Outcome<StoredCampaign> find_campaign(Application& application, const std::string& name,
                                      const CallContext& call) {
  const std::optional<std::int64_t> number = campaign_id(name);
  if (!number) {
    return invalid({{"name", "not a name of the form \"campaigns/{id}\", id a number"}});
  }
  auto stored = application.store.numbered_campaign(call.project, *number, call.limits);
  if (!stored) return no_campaign(name);
  return std::move(*stored);
}

Outcome<v1::Campaign> create_campaign(Application& application,
                                      const v1::CreateCampaignRequest& request,
                                      const CallContext& call) {
  Violations violations;
  check_request_id(request.request_id(), violations);
  if (!request.has_campaign()) violations.push_back({"campaign", "not set"});
  if (!violations.empty()) return invalid(violations);
  v1::Campaign stated = request.campaign();
  keep_client_part(stated);
  // Before the inputs are checked: the resources may have changed since the earlier request.
  if (!request.request_id().empty()) {
    const auto stored =
        application.store.campaign_of_request(call.project, request.request_id(), call.limits);
    if (stored) {
      auto answer = repeated_answer(application, *stored, request, stated, call);
      if (!request.validate_only() || !answer.ok()) return answer;
    }
  }
  const auto inputs =
      read_campaign(stated, resource_lookup(application.store, call.project, call.limits),
                    "campaign", violations);
  if (!inputs) return invalid(violations);
  const NewCampaign campaign = new_campaign(request, *inputs, request_hash(stated), call);
  if (request.validate_only()) return campaign_preview(*inputs, campaign);
  if (auto full = project_full(application, call)) return *std::move(full);
  if (application.jobs.is_stopping()) return shutting_down();
  WorkPlace place;
  if (auto refused = take_hours(application, campaign.cost_seconds, call, place)) {
    return *std::move(refused);
  }
  const auto admitted = application.jobs.campaigns().submit(campaign, call.limits);
  if (!admitted.has_place) return campaign_turned_away(application);
  const StoredCampaign& stored = admitted.added.stored;
  if (admitted.added.kind != CampaignAdded::Kind::kAdded) {
    return repeated_answer(application, stored, request, stated, call);
  }
  // The names of request, campaign and inputs; no inputs.
  spdlog::info(
      "event=campaign_created campaign={} request_id={} client={} input_hash={} points={} call={}",
      name_of(stored), campaign.request_id, campaign.client, campaign.input_hash, stored.points(),
      call.request_id);
  return to_message(application, stored);
}

Outcome<v1::Campaign> get_campaign(Application& application, const v1::GetCampaignRequest& request,
                                   const CallContext& call) {
  Violations violations;
  check_choice(request, "view", violations);
  if (!violations.empty()) return invalid(violations);
  const auto found = find_campaign(application, request.name(), call);
  if (!found.ok()) return found.error();
  const StoredCampaign& stored = found.message();
  v1::Campaign out = to_message(application, stored);
  add_rows_state(application, stored, call, out);
  if (request.view() == v1::CAMPAIGN_VIEW_FULL) {
    out.MergeFromString(application.store.candidate_table(stored.id, call.limits));
  }
  return out;
}

Outcome<v1::ListCampaignsResponse> list_campaigns(Application& application,
                                                  const v1::ListCampaignsRequest& request,
                                                  const CallContext& call) {
  Violations violations;
  const int size = page_size(request.page_size(), kDefaultCampaignPage, violations);
  const std::string scope = full_name(call.project, kCampaigns);
  std::int64_t before = 0;
  if (!request.page_token().empty()) {
    const auto token = parse_page_token(application.page_token_key, scope, request.page_token());
    const auto number = token ? campaign_id(token->last.name) : std::nullopt;
    if (!number) add_bad_page_token(violations);
    before = number.value_or(0);
  }
  if (!violations.empty()) return invalid(violations);
  const Page<StoredCampaign> page =
      application.store.campaigns(call.project, before, size, call.limits);
  v1::ListCampaignsResponse response;
  response.set_total_size(clamped_total(page.total));
  std::size_t bytes = 0;
  bool is_cut = false;
  for (const StoredCampaign& row : page.rows) {
    v1::Campaign next = to_message(application, row);
    bytes += next.ByteSizeLong();
    is_cut = response.campaigns_size() > 0 && bytes > kMaximumPageBytes;
    if (is_cut) break;
    *response.add_campaigns() = std::move(next);
  }
  if (page.more || is_cut) {
    const StoredCampaign& last = page.rows[static_cast<std::size_t>(response.campaigns_size() - 1)];
    response.set_next_page_token(page_token(application.page_token_key, scope,
                                            {{last.number, relative_name(name_of(last))}, 0}));
  }
  return response;
}

Outcome<v1::Campaign> pause_campaign(Application& application,
                                     const v1::PauseCampaignRequest& request,
                                     const CallContext& call) {
  const auto found = find_campaign(application, request.name(), call);
  if (!found.ok()) return found.error();
  return changed_answer(application, request.name(),
                        application.jobs.campaigns().pause(found.message().id, call.limits));
}

Outcome<v1::Campaign> resume_campaign(Application& application,
                                      const v1::ResumeCampaignRequest& request,
                                      const CallContext& call) {
  Violations violations;
  if (request.has_budget()) check_message(request.budget(), "budget", violations);
  const auto found = find_campaign(application, request.name(), call);
  if (!found.ok()) return found.error();
  if (!violations.empty()) return invalid(violations);
  std::optional<CampaignBudget> budget;
  if (request.has_budget()) budget = to_budget(request.budget());
  WorkPlace place;
  if (found.message().state == CampaignState::kPaused) {
    auto refused = take_hours(application, found.message().remaining_seconds(), call, place);
    if (refused) return *std::move(refused);
  }
  const auto stored = application.jobs.campaigns().go_on(found.message().id, budget, call.limits);
  if (!stored) return no_campaign(request.name());
  if (!has_ended(stored->state)) return to_message(application, *stored);
  const std::string state =
      v1::Campaign::State_Name(static_cast<v1::Campaign::State>(stored->state));
  return not_possible(v1::ERROR_REASON_ENDED, kCampaignType, request.name(),
                      fmt::format("{} is {}; only a campaign that has not ended can be resumed",
                                  request.name(), state),
                      {{"state", state}});
}

Outcome<v1::Campaign> cancel_campaign(Application& application,
                                      const v1::CancelCampaignRequest& request,
                                      const CallContext& call) {
  const auto found = find_campaign(application, request.name(), call);
  if (!found.ok()) return found.error();
  return changed_answer(application, request.name(),
                        application.jobs.campaigns().cancel(found.message().id, call.limits));
}

Outcome<google::protobuf::Empty> delete_campaign(Application& application,
                                                 const v1::DeleteCampaignRequest& request,
                                                 const CallContext& call) {
  using google::protobuf::Empty;
  for (int attempt = 0; attempt < kCampaignDeletions; ++attempt) {
    const auto found = find_campaign(application, request.name(), call);
    if (!found.ok()) {
      const bool is_missing = found.error().code() == google::rpc::NOT_FOUND;
      if (is_missing && request.allow_missing()) return Empty();
      return found.error();
    }
    const StoredCampaign& stored = found.message();
    if (!has_ended(stored.state)) {
      const std::string state =
          v1::Campaign::State_Name(static_cast<v1::Campaign::State>(stored.state));
      if (!request.cancel()) {
        return not_possible(v1::ERROR_REASON_NOT_ENDED, kCampaignType, request.name(),
                            fmt::format("{} is {}; cancel it to delete it", request.name(), state),
                            {{"state", state}});
      }
      application.jobs.campaigns().cancel(stored.id, call.limits);
    }
    if (application.store.remove_campaign(stored.id, call.limits)) return Empty();
  }
  return contention(kCampaignType, request.name());
}

}  // namespace tribodyn::server
