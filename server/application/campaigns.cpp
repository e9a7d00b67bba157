#include "server/application/campaigns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "server/application/campaign_messages.h"
#include "server/application/errors.h"
#include "server/application/label_update.h"
#include "server/application/list_filter.h"
#include "server/application/page_token.h"
#include "server/application/paging.h"
#include "server/application/project_space.h"
#include "server/application/read_mask.h"
#include "server/contract/check_message.h"
#include "server/simulation/campaign_inputs.h"

namespace tribodyn::server {
namespace {

constexpr int kDefaultCampaignPage = 50;
// What an update may change beside the name and the labels.
constexpr char kWeights[] = "condition_weights", kAttributes[] = "candidate_attributes";
constexpr int kCampaignDeletions = 10;  // attempts, against others that resume it
// Fields of an answer that are read from the rows of a campaign, and from its table of candidates.
constexpr std::array<std::string_view, 2> kRowsState = {"first_missing_row", "refusals"};
constexpr std::array<std::string_view, 3> kCandidateTable = {
    "candidate_columns", "candidate_attributes", "candidate_lubricants"};

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

/// Takes over the weights and the attributes that an update changes. Returns the table of
/// candidates with the new attributes; nullopt if they stay.
std::optional<v1::Campaign> take_over_descriptions(Application& application,
                                                   const StoredCampaign& stored,
                                                   const v1::UpdateCampaignRequest& request,
                                                   v1::Campaign& changed, const CallContext& call,
                                                   Violations& violations) {
  const auto& paths = request.update_mask().paths();
  const auto asks_for = [&paths](const char* path) {
    return std::find(paths.begin(), paths.end(), path) != paths.end();
  };
  if (!asks_for(kWeights) && !asks_for(kAttributes)) return std::nullopt;
  v1::Campaign table;
  table.ParseFromString(application.store.candidate_table(stored.id, call.limits));
  if (asks_for(kWeights)) {
    *changed.mutable_condition_weights() = request.campaign().condition_weights();
  }
  if (asks_for(kAttributes)) {
    replace_attributes(request.campaign().candidate_attributes(), table, violations);
  }
  check_descriptions(changed, table, stored.candidates, "campaign", violations);
  if (!asks_for(kAttributes)) return std::nullopt;
  return table;
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

Outcome<v1::Campaign> get_campaign(Application& application, const v1::GetCampaignRequest& request,
                                   const CallContext& call) {
  Violations violations;
  check_choice(request, "view", violations);
  const ReadMask mask(request.read_mask(), *v1::Campaign::descriptor(), violations);
  if (!violations.empty()) return invalid(violations);
  const auto found = find_campaign(application, request.name(), call);
  if (!found.ok()) return found.error();
  const StoredCampaign& stored = found.message();
  v1::Campaign out = to_message(application, stored);
  const auto asks_for = [&mask](std::string_view field) { return mask.asks_for(field); };
  if (std::ranges::any_of(kRowsState, asks_for)) add_rows_state(application, stored, call, out);
  const bool has_table = request.view() == v1::CAMPAIGN_VIEW_FULL ||
                         (request.view() == v1::CAMPAIGN_VIEW_UNSPECIFIED && !mask.is_whole());
  if (has_table && std::ranges::any_of(kCandidateTable, asks_for)) {
    out.MergeFromString(application.store.candidate_table(stored.id, call.limits));
  }
  mask.apply(out);
  return out;
}

Outcome<v1::ListCampaignsResponse> list_campaigns(Application& application,
                                                  const v1::ListCampaignsRequest& request,
                                                  const CallContext& call) {
  Violations violations;
  const int size = page_size(request.page_size(), kDefaultCampaignPage, violations);
  const std::string scope = full_name(call.project, kCampaigns) + "\n" + request.filter();
  std::int64_t before = 0;
  std::vector<Restriction> restrictions =
      parse_job_filter(request.filter(), kCampaigns, violations);
  const ReadMask mask(request.read_mask(), *v1::Campaign::descriptor(), violations);
  if (!request.page_token().empty()) {
    const auto token = parse_page_token(application.page_token_key, scope, request.page_token());
    const auto number = token ? campaign_id(token->last.name) : std::nullopt;
    if (!number) add_bad_page_token(violations);
    before = number.value_or(0);
  }
  if (!violations.empty()) return invalid(violations);
  const Page<StoredCampaign> page = application.store.campaigns(
      {call.project, std::move(restrictions), before, size}, call.limits);
  v1::ListCampaignsResponse response;
  response.set_total_size(clamped_total(page.total));
  std::size_t bytes = 0;
  bool is_cut = false;
  for (const StoredCampaign& row : page.rows) {
    v1::Campaign next = to_message(application, row);
    mask.apply(next);
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

Outcome<v1::Campaign> update_campaign(Application& application,
                                      const v1::UpdateCampaignRequest& request,
                                      const CallContext& call) {
  const std::string& name = request.campaign().name();
  for (int attempt = 0; attempt < kCampaignWrites; ++attempt) {
    const auto found = find_campaign(application, name, call);
    if (!found.ok()) return found.error();
    v1::Campaign changed;
    changed.ParseFromString(found.message().request);
    Violations violations;
    take_over_labels(request.update_mask(), request.campaign(), "campaign", changed, violations,
                     {kWeights, kAttributes});
    std::optional<v1::Campaign> table;
    if (violations.empty()) {
      table =
          take_over_descriptions(application, found.message(), request, changed, call, violations);
    }
    if (!violations.empty()) return invalid(violations);
    if (table) {
      if (auto full = project_full(application, call)) return *std::move(full);
    }
    const auto updated = application.store.describe_campaign(
        found.message(), changed.SerializeAsString(), labels_of(changed),
        table ? std::optional(table->SerializeAsString()) : std::nullopt, call.limits);
    if (updated) return to_message(application, *updated);
  }
  return contention(kCampaignType, name);
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
