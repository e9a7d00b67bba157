#include "server/simulation/campaign_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "core/refusal.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/contract/output_only.h"
#include "server/simulation/campaign_columns.h"
#include "server/simulation/cost_estimate.h"
#include "server/simulation/input_hash.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

/// Largest number of conditions that share a prepared scene, and so are computed between two looks
/// at the clock: some 20 ms.
constexpr std::size_t kMaximumGroup = 256;
constexpr std::size_t kMaximumDifferentiatedGroup = 16;  // the same with elasticities: some 15 ms
constexpr std::size_t kMaximumAttributeName = 63;

/// Moves the columns of candidates out of a campaign.
v1::Campaign take_table(v1::Campaign& campaign) {
  v1::Campaign out;
  out.mutable_candidate_columns()->Swap(campaign.mutable_candidate_columns());
  out.mutable_candidate_attributes()->Swap(campaign.mutable_candidate_attributes());
  return out;
}

v1::EvaluatePointsRequest points_request(const v1::Campaign& requested, v1::Campaign& table) {
  v1::EvaluatePointsRequest out;
  out.set_lubricant(requested.lubricant());
  out.set_gear_set(requested.gear_set());
  out.set_surface(requested.surface());
  out.set_vehicle(requested.vehicle());
  if (requested.has_model_options()) *out.mutable_model_options() = requested.model_options();
  out.set_tolerance(requested.tolerance());
  out.mutable_candidate_columns()->Swap(table.mutable_candidate_columns());
  *out.mutable_conditions() = requested.conditions();
  out.set_contact_figures(requested.contact_figures());
  *out.mutable_elasticity_parameters() = requested.elasticity_parameters();
  *out.mutable_elasticity_figures() = requested.elasticity_figures();
  return out;
}

bool is_column_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaximumAttributeName &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '-' || c == '_' || c == '.';
         });
}

/// Names that an attribute may not have, as other columns have them.
std::set<std::string, std::less<>> taken_names(const v1::Campaign& requested) {
  std::set<std::string, std::less<>> out{"candidate", "condition"};
  for (std::string& each : campaign_columns(requested)) out.insert(std::move(each));
  for (std::string& each : candidate_parameter_names()) out.insert(std::move(each));
  const auto& condition = *v1::PointCondition::descriptor();
  for (int i = 0; i < condition.field_count(); ++i) out.insert(condition.field(i)->name());
  return out;
}

void check_attributes(const v1::Campaign& requested, const v1::Campaign& table,
                      Violations& violations) {
  auto taken = taken_names(requested);
  const int candidates =
      table.candidate_columns().empty() ? 1 : table.candidate_columns(0).values_size();
  for (int i = 0; i < table.candidate_attributes_size(); ++i) {
    const v1::CandidateAttribute& each = table.candidate_attributes(i);
    const std::string path = fmt::format("candidate_attributes[{}]", i);
    if (!is_column_name(each.name())) {
      violations.push_back(
          {path + ".name", fmt::format("\"{}\"; allowed: 1 to {} letters, digits, '-', '_' and '.'",
                                       plain_excerpt(each.name()), kMaximumAttributeName)});
    } else if (!taken.insert(each.name()).second) {
      violations.push_back(
          {path + ".name",
           fmt::format("\"{}\" is the name of another column; choose another one", each.name())});
    }
    const int texts = each.texts_size(), numbers = each.values_size();
    if ((texts == 0) == (numbers == 0) || texts + numbers != candidates) {
      violations.push_back(
          {path, fmt::format("{} texts and {} values; allowed: {} of one kind, one for each "
                             "candidate",
                             texts, numbers, candidates)});
    }
  }
}

void check_weights(const v1::Campaign& campaign, Violations& violations) {
  const int weights = campaign.condition_weights_size();
  if (weights == 0 || weights == campaign.conditions_size()) return;
  violations.push_back(
      {"condition_weights", fmt::format("{} weights; allowed: none, or one for each of the {} "
                                        "conditions",
                                        weights, campaign.conditions_size())});
}

/// Checks what read_points() does not see.
void check_rest(const v1::Campaign& requested, const v1::Campaign& table, Violations& violations) {
  v1::Campaign rest;
  rest.set_display_name(requested.display_name());
  *rest.mutable_condition_weights() = requested.condition_weights();
  if (requested.has_budget()) *rest.mutable_budget() = requested.budget();
  *rest.mutable_candidate_attributes() = table.candidate_attributes();
  check_message(rest, "", violations);
}

/// Divides groups of more conditions than a unit of work has.
void divide_groups(PointEvaluation& points) {
  const std::size_t most =
      points.elasticities.empty() ? kMaximumGroup : kMaximumDifferentiatedGroup;
  std::vector<PointEvaluation::Group> out;
  for (PointEvaluation::Group& group : points.groups) {
    for (std::size_t i = 0; i < group.conditions.size(); i += most) {
      const auto begin = group.conditions.begin() + static_cast<std::ptrdiff_t>(i);
      const std::size_t count = std::min(most, group.conditions.size() - i);
      out.push_back({group.sump_temperature_celsius,
                     group.inlet_temperature_rise_kelvin,
                     {begin, begin + static_cast<std::ptrdiff_t>(count)}});
    }
  }
  points.groups = std::move(out);
}

void add_number(double value, Sha256& hash) {
  hash.add({reinterpret_cast<const char*>(&value), sizeof value});
}

/// The hash differs from that of any simulation: figures of screening are right within the same
/// tolerance, not the same to the last bit.
std::string hash_of(const PointEvaluation& points) {
  Sha256 hash;
  hash.add("campaign by screening\n");
  hash.add(canonical_inputs(points.base));
  for (const PointEvaluation::Column& column : points.columns) {
    hash.add(column.field->full_name());
    for (const double value : column.values) add_number(value, hash);
  }
  for (const PointEvaluation::Group& group : points.groups) {
    for (const auto& [position, condition] : group.conditions) {
      for (const double value :
           {static_cast<double>(position), group.sump_temperature_celsius,
            group.inlet_temperature_rise_kelvin, condition.vehicle_speed, condition.ascent_angle}) {
        add_number(value, hash);
      }
    }
  }
  if (points.with_contact) hash.add("contact figures\n");
  for (const Elasticity& each : points.elasticities) {
    hash.add("elasticity of " + each.figure + " by " + each.parameter + "\n");
  }
  return hash.finish();
}

/// As read_campaign(), without input_hash.
std::optional<CampaignInputs> check_campaign(v1::Campaign request, const ResourceLookup& lookup,
                                             const std::string& path, Violations& violations) {
  Violations found;
  keep_client_part(request);
  CampaignInputs out;
  out.table = take_table(request);
  out.requested = std::move(request);
  check_attributes(out.requested, out.table, found);
  check_weights(out.requested, found);
  check_rest(out.requested, out.table, found);
  v1::EvaluatePointsRequest points = points_request(out.requested, out.table);
  auto read =
      read_points(points, lookup, found, kMaximumCampaignPoints, "in one campaign; make several");
  out.table.mutable_candidate_columns()->Swap(points.mutable_candidate_columns());
  for (Violation& each : found) {
    violations.push_back({join_path(path, each.field), std::move(each.description)});
  }
  if (!read || !found.empty()) return std::nullopt;
  out.points = std::move(*read);
  out.columns = campaign_columns(out.requested).size();
  divide_groups(out.points);
  return out;
}

}  // namespace

std::optional<CampaignInputs> read_campaign(v1::Campaign request, const ResourceLookup& lookup,
                                            const std::string& path, Violations& violations) {
  auto out = check_campaign(std::move(request), lookup, path, violations);
  if (out) out->input_hash = hash_of(out->points);
  return out;
}

CampaignInputs stored_campaign_inputs(const StoredCampaign& stored, const std::string& table,
                                      const ResourceLookup& lookup) {
  v1::Campaign request;
  // Fields of the second message join those of the first.
  if (!request.ParseFromString(stored.request) || !request.MergeFromString(table)) {
    throw Refusal("STORED_REQUEST_UNREADABLE", "the stored request cannot be read");
  }
  // An older server may have accepted it with other defaults.
  request.set_lubricant(stored.lubricant_revision);
  request.set_gear_set(stored.gear_set_revision);
  request.set_surface(stored.surface_revision);
  request.set_vehicle(stored.vehicle_revision);
  Violations violations;
  auto inputs = check_campaign(std::move(request), lookup, "campaign", violations);
  if (!inputs) {
    throw Refusal("STORED_REQUEST_INVALID",
                  violations.front().field + ": " + violations.front().description);
  }
  return std::move(*inputs);
}

v1::CostEstimate estimate_cost(const CampaignInputs& inputs) {
  std::vector<double> speeds;
  for (const v1::PointCondition& each : inputs.requested.conditions()) {
    speeds.push_back(each.speed_kilometres_per_hour());
  }
  return estimate_screening_cost(
      inputs.points.base.effective, inputs.points.candidates, speeds,
      {.contact = inputs.points.with_contact, .elasticities = !inputs.points.elasticities.empty()});
}

}  // namespace tribodyn::server
