#include <fmt/format.h>
#include <google/protobuf/util/message_differencer.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>

#include "core/version.h"
#include "server/application/campaign_messages.h"
#include "server/application/campaigns.h"
#include "server/application/computed_fields.h"
#include "server/application/errors.h"
#include "server/application/label_update.h"
#include "server/application/list_filter.h"
#include "server/application/project_space.h"
#include "server/application/request_text.h"
#include "server/application/stored_messages.h"
#include "server/contract/constraints.h"
#include "server/contract/output_only.h"
#include "server/simulation/campaign_inputs.h"
#include "server/simulation/result_key.h"
#include "server/storage/resource_lookup.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

constexpr std::size_t kMaximumSearchedBytes = 256 << 20;

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
}

/// Returns the first field in which a stored campaign differs from a request under its request_id;
/// empty if it differs in none. If this request made the campaign, only weights and attributes are
/// compared: UpdateCampaign may have changed them. A new name or new labels are no difference.
std::string differing_field(Application& application, const StoredCampaign& stored,
                            const v1::Campaign& stated, const CallContext& call) {
  v1::Campaign earlier;
  earlier.ParseFromString(stored.request);
  earlier.MergeFromString(application.store.candidate_table(stored.id, call.limits));
  keep_stated(stated, application.store.created_candidates(stored.id, call.limits), earlier);
  const bool made_it = stored.request_hash == request_hash(stated);
  const auto& type = *v1::Campaign::descriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const int number = type.field(i)->number();
    if (made_it && number != v1::Campaign::kConditionWeightsFieldNumber &&
        number != v1::Campaign::kCandidateAttributesFieldNumber) {
      continue;
    }
    google::protobuf::util::MessageDifferencer differencer;
    if (differencer.CompareWithFields(earlier, stated, {type.field(i)}, {type.field(i)})) continue;
    return "campaign." + type.field(i)->name();
  }
  return "";
}

/// The answer to a request whose request_id made the stored campaign.
Outcome<v1::Campaign> repeated_answer(Application& application, const StoredCampaign& stored,
                                      const v1::CreateCampaignRequest& request,
                                      const v1::Campaign& stated, const CallContext& call) {
  const std::string field = differing_field(application, stored, stated, call);
  if (field.empty()) {
    application.jobs.campaigns().ensure_queued(stored);
    return to_message(application, stored);
  }
  return already_exists(
      v1::ERROR_REASON_REQUEST_ID_REUSED, kCampaignType, name_of(stored),
      fmt::format("request_id \"{}\" made {} by a request that differs in {}; take another one",
                  request.request_id(), name_of(stored), field),
      {{"request_id", request.request_id()}, {"field", field}},
      {{"request_id", fmt::format("belongs to another request; it differs in {}", field)}});
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
  out.revisions = {effective.lubricant_revision(), effective.gear_set_revision(),
                   effective.surface_revision(), effective.vehicle_revision()};
  out.labels = labels_of(inputs.requested);
  out.candidate_lubricants = {inputs.table.candidate_lubricants().begin(),
                              inputs.table.candidate_lubricants().end()};
  return out;
}

/// Returns the campaign that a request with validate_only would create, without a name.
v1::Campaign campaign_preview(const CampaignInputs& inputs, const NewCampaign& campaign) {
  v1::Campaign out = inputs.requested;
  set_revisions(campaign.revisions, out);
  out.set_state(v1::Campaign::RUNNING);
  out.set_candidates(campaign.candidates);
  out.set_points(campaign.candidates * campaign.conditions);
  out.set_input_hash(campaign.input_hash);
  out.set_model_version(campaign.model_version);
  *out.mutable_cost_estimate() = estimate_cost(inputs);
  return out;
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
      violations.add("filter", "the lubricants are larger than {} MB together; allowed: fewer",
                     kMaximumSearchedBytes >> 20U);
    }
    for (const StoredResource& each : page.rows) {
      out.push_back(revision_name(relative_name(each.name), each.revision));
    }
    return out;
  };
}

}  // namespace

Outcome<v1::Campaign> create_campaign(Application& application,
                                      const v1::CreateCampaignRequest& request,
                                      const CallContext& call) {
  Violations violations;
  check_request_id(request.request_id(), violations);
  if (!request.has_campaign()) violations.add("campaign", "not set");
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
  auto inputs = read_campaign(stated, resource_lookup(application.store, call.project, call.limits),
                              "campaign", violations, lubricant_search(application, call));
  if (!inputs) return invalid(violations);
  const NewCampaign campaign = new_campaign(request, *inputs, request_hash(stated), call);
  if (request.validate_only()) return campaign_preview(*inputs, campaign);
  if (auto full = project_full(application, call)) return *std::move(full);
  if (application.jobs.scheduler().is_stopping()) return shutting_down();
  WorkPlace place;
  if (auto refused = take_hours(application, campaign.cost_seconds, call, place)) {
    return *std::move(refused);
  }
  const auto admitted =
      application.jobs.campaigns().submit(campaign, *std::move(inputs), call.limits);
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

}  // namespace tribodyn::server
