#include "server/application/campaigns.h"

#include <fmt/format.h>
#include <google/protobuf/util/message_differencer.h>
#include <google/protobuf/util/time_util.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "core/version.h"
#include "server/application/computed_fields.h"
#include "server/application/errors.h"
#include "server/application/label_update.h"
#include "server/application/list_filter.h"
#include "server/application/page_token.h"
#include "server/application/paging.h"
#include "server/application/project_space.h"
#include "server/application/read_mask.h"
#include "server/application/request_text.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/contract/output_only.h"
#include "server/simulation/campaign_inputs.h"
#include "server/simulation/result_key.h"
#include "server/storage/resource_lookup.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

constexpr int kDefaultCampaignPage = 50;
constexpr int kCampaignDeletions = 10;  // attempts, against others that resume it
constexpr int kCampaignWrites = 10;     // attempts, against other writers
constexpr std::size_t kMaximumSearchedBytes = 256 << 20;
constexpr char kCampaignType[] = "tribodyn.v1.Campaign";
// Fields of an answer that are read from the rows of a campaign, and from its table of candidates.
constexpr std::array<std::string_view, 2> kRowsState = {"first_missing_row", "refusals"};
constexpr std::array<std::string_view, 3> kCandidateTable = {
    "candidate_columns", "candidate_attributes", "candidate_lubricants"};

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

/// Prepares the stored campaign `earlier` for a comparison with `stated`, a request under the same
/// request_id: removes what its own request did not state, which are candidates that were added
/// later, and columns, attributes and lubricants that the server made.
void keep_stated(const v1::Campaign& stated, int created_candidates, v1::Campaign& earlier) {
  const bool is_of_lubricants = has_lubricants(earlier, earlier);
  keep_first_candidates(created_candidates, earlier);
  if (earlier.has_candidate_design() || is_of_lubricants) earlier.clear_candidate_columns();
  auto& attributes = *earlier.mutable_candidate_attributes();
  for (int i = attributes.size() - 1; i >= 0; --i) {
    if (is_of_lubricants && is_made_attribute(attributes[i].name())) {
      attributes.DeleteSubrange(i, 1);
    }
  }
  auto& lubricants = *earlier.mutable_candidate_lubricants();
  if (!earlier.lubricant_filter().empty()) lubricants.Clear();
  for (int i = 0; i < std::min(lubricants.size(), stated.candidate_lubricants_size()); ++i) {
    const bool names_revision = stated.candidate_lubricants(i).find('@') != std::string::npos;
    if (!names_revision) lubricants[i].resize(lubricants[i].find('@'));
  }
  if (stated.lubricant().empty() && is_of_lubricants) earlier.clear_lubricant();
  if (earlier.has_candidate_design() && stated.candidate_design().algorithm_version() == 0) {
    earlier.mutable_candidate_design()->clear_algorithm_version();
  }
  // Name and labels may have changed since; where they alone seem to differ, they are named.
}

google::rpc::Status campaign_request_id_taken(Application& application,
                                              const StoredCampaign& stored,
                                              const v1::CreateCampaignRequest& request,
                                              const v1::Campaign& stated, const CallContext& call) {
  v1::Campaign earlier;
  earlier.ParseFromString(stored.request);
  earlier.MergeFromString(application.store.candidate_table(stored.id, call.limits));
  keep_stated(stated, application.store.created_candidates(stored.id, call.limits), earlier);
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

CampaignLabels labels_of(const v1::Campaign& campaign) {
  CampaignLabels out;
  for (const v1::Label& each : campaign.labels()) out.emplace_back(each.key(), each.value());
  return out;
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
  out.labels = labels_of(inputs.requested);
  out.candidate_lubricants = {inputs.table.candidate_lubricants().begin(),
                              inputs.table.candidate_lubricants().end()};
  return out;
}

/// Returns the campaign with candidates that a request with validate_only would add.
v1::Campaign append_preview(Application& application, const StoredCampaign& stored,
                            const NewCandidates& candidates) {
  v1::Campaign out = to_message(application, stored);
  if (stored.state == CampaignState::kSucceeded) {
    out.set_state(v1::Campaign::RUNNING);
    out.clear_end_time();
    out.clear_expire_time();
  }
  out.set_candidates(candidates.candidates);
  out.set_points(candidates.candidates * stored.conditions);
  out.set_input_hash(candidates.input_hash);
  out.mutable_cost_estimate()->set_processor_seconds(candidates.cost_seconds);
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

/// Returns the search of the lubricants that satisfy a filter, as ListLubricants finds them.
LubricantSearch lubricant_search(Application& application, const CallContext& call) {
  return [&application, &call](const std::string& filter, Violations& violations) {
    ResourceQuery query;
    query.project = call.project;
    query.collection = kLubricants;
    query.limit = kMaximumCandidateLubricants + 1;
    query.byte_limit = kMaximumSearchedBytes;
    query.restrictions = parse_filter(filter, query.collection, violations);
    std::vector<std::string> out;
    if (!violations.empty()) return out;
    const auto read_page = [&](const ResourceQuery& stored) {
      return application.store.resources(stored, call.limits);
    };
    const Page<StoredResource> page = needs_computed_fields(query)
                                          ? query_by_computed_fields(query, read_page)
                                          : read_page(query);
    if (page.more && page.rows.size() <= static_cast<std::size_t>(kMaximumCandidateLubricants)) {
      violations.push_back({"filter", fmt::format("the lubricants are larger than {} MB together; "
                                                  "allowed: fewer",
                                                  kMaximumSearchedBytes >> 20U)});
    }
    for (const StoredResource& each : page.rows) {
      out.push_back(revision_name(relative_name(each.name), each.revision));
    }
    return out;
  };
}

/// Reads the filter of a list of campaigns.
std::vector<Restriction> campaign_restrictions(const std::string& filter, Violations& violations) {
  std::vector<Restriction> out = parse_filter(filter, kCampaigns, violations);
  for (Restriction& each : out) {
    using enum Restriction::Comparison;
    const bool is_label = each.key.starts_with("labels.");
    const bool is_equality = each.comparison == kEqual || each.comparison == kNotEqual;
    if (each.key == "name") {
      violations.push_back({"filter", "lists cannot be filtered by name; use GetCampaign"});
    } else if (!is_equality && !(is_label && each.comparison == kPresent) &&
               !(each.key == "display_name" && each.comparison == kContains)) {
      violations.push_back({"filter", each.key + ": allowed: = or !=, of labels also :*, of "
                                                 "display_name also :"});
    }
    const std::string* word = std::get_if<std::string>(&each.value);
    v1::Campaign::State state = v1::Campaign::STATE_UNSPECIFIED;
    if (each.key == "state" && word != nullptr && v1::Campaign::State_Parse(*word, &state)) {
      each.value = std::int64_t{state};
    }
  }
  return out;
}

/// Why no candidates can be added to a campaign; nullopt if they can.
std::optional<google::rpc::Status> not_appendable(const StoredCampaign& stored,
                                                  const std::string& name) {
  if (stored.state > CampaignState::kSucceeded) {
    const std::string state =
        v1::Campaign::State_Name(static_cast<v1::Campaign::State>(stored.state));
    return not_possible(v1::ERROR_REASON_ENDED, kCampaignType, name,
                        fmt::format("{} is {}; candidates can be added to a campaign that is "
                                    "RUNNING, PAUSED or SUCCEEDED. Create another one",
                                    name, state),
                        {{"state", state}});
  }
  if (stored.model_version == kModelVersion && stored.platform == platform()) return std::nullopt;
  return not_possible(
      v1::ERROR_REASON_MODEL_CHANGED, kCampaignType, name,
      fmt::format("the rows of {} are of model {} on {}, this server computes model {} on {}; "
                  "create another campaign",
                  name, stored.model_version, stored.platform, kModelVersion, platform()),
      {{"model_version", stored.model_version}});
}

google::rpc::Status append_id_taken(const v1::AppendCandidatesRequest& request) {
  return already_exists(
      v1::ERROR_REASON_REQUEST_ID_REUSED, kCampaignType, request.name(),
      fmt::format("request_id \"{}\" added other candidates to {}; take another one",
                  request.request_id(), request.name()),
      {{"request_id", request.request_id()}, {"field", "candidate_columns"}},
      {{"request_id", "belongs to another request, with other candidates"}});
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
                    "campaign", violations, lubricant_search(application, call));
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
  std::vector<Restriction> restrictions = campaign_restrictions(request.filter(), violations);
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
    take_over_labels(request.update_mask(), request.campaign(), "campaign", changed, violations);
    if (!violations.empty()) return invalid(violations);
    const auto updated = application.store.relabel_campaign(
        found.message(), changed.SerializeAsString(), labels_of(changed), call.limits);
    if (updated) return to_message(application, *updated);
  }
  return contention(kCampaignType, name);
}

Outcome<v1::Campaign> append_candidates(Application& application,
                                        const v1::AppendCandidatesRequest& request,
                                        const CallContext& call) {
  Violations violations;
  check_request_id(request.request_id(), violations);
  check_message(request, "", violations);
  if (!violations.empty()) return invalid(violations);
  v1::AppendCandidatesRequest stated = request;
  stated.clear_name();
  stated.clear_validate_only();
  NewCandidates candidates;
  candidates.request_id = request.request_id();
  candidates.request_hash = sha256(stated.SerializeAsString());
  for (int attempt = 0; attempt < kCampaignWrites; ++attempt) {
    const auto found = find_campaign(application, request.name(), call);
    if (!found.ok()) return found.error();
    const StoredCampaign& stored = found.message();
    // Before the state is checked: the campaign may have been cancelled since the earlier request.
    const auto earlier = application.store.append_of_request(stored.id, candidates.request_id,
                                                             candidates.request_hash, call.limits);
    if (earlier == CandidatesAdded::Kind::kRequestIdTaken) return append_id_taken(request);
    if (earlier) {
      application.jobs.campaigns().ensure_queued(stored);
      return to_message(application, stored);
    }
    if (auto refused = not_appendable(stored, request.name())) return *std::move(refused);
    auto appended =
        read_appended(stored, application.store.candidate_table(stored.id, call.limits), request,
                      resource_lookup(application.store, call.project, call.limits),
                      accepted_lookup(application.store, call.project,
                                      {stored.lubricant_revision, stored.gear_set_revision,
                                       stored.surface_revision, stored.vehicle_revision}),
                      violations);
    if (!appended) return invalid(violations);
    candidates.campaign = stored.id;
    candidates.candidates_before = stored.candidates;
    candidates.candidates = appended->all.points.candidates;
    candidates.candidate_table = appended->all.table.SerializeAsString();
    candidates.input_hash = appended->all.input_hash;
    candidates.cost_seconds = appended->cost_seconds;
    candidates.candidate_lubricants = appended->candidate_lubricants;
    if (request.validate_only()) return append_preview(application, stored, candidates);
    if (auto full = project_full(application, call)) return *std::move(full);
    if (application.jobs.is_stopping()) return shutting_down();
    WorkPlace place;
    if (auto refused = take_hours(application, candidates.cost_seconds, call, place)) {
      return *std::move(refused);
    }
    const auto outcome = application.jobs.campaigns().append(
        candidates, std::make_shared<CampaignInputs>(std::move(appended->all)), call.limits);
    if (!outcome.has_place) return campaign_turned_away(application);
    if (outcome.added.kind == CandidatesAdded::Kind::kRequestIdTaken) {
      return append_id_taken(request);
    }
    if (outcome.added.kind == CandidatesAdded::Kind::kChanged) continue;
    spdlog::info("event=candidates_added campaign={} request_id={} candidates={} call={}",
                 name_of(stored), candidates.request_id,
                 candidates.candidates - candidates.candidates_before, call.request_id);
    return to_message(application, *outcome.added.stored);
  }
  return contention(kCampaignType, request.name());
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
