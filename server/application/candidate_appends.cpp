#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <optional>

#include "core/version.h"
#include "server/application/campaign_messages.h"
#include "server/application/campaigns.h"
#include "server/application/errors.h"
#include "server/application/project_space.h"
#include "server/application/request_text.h"
#include "server/contract/check_message.h"
#include "server/simulation/campaign_inputs.h"
#include "server/simulation/result_key.h"
#include "server/storage/resource_lookup.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

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

}  // namespace

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
    auto appended = read_appended(
        stored, application.store.candidate_table(stored.id, call.limits), request,
        resource_lookup(application.store, call.project, call.limits),
        accepted_lookup(application.store, call.project, stored.revisions), violations);
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
    if (application.jobs.scheduler().is_stopping()) return shutting_down();
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

}  // namespace tribodyn::server
