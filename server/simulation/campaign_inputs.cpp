#include "server/simulation/campaign_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "core/refusal.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/contract/labels.h"
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
constexpr std::size_t kMaximumDifferentiatedGroup = 16;  // the same with elasticities: some 3 ms
constexpr std::size_t kMaximumAttributeName = 63;

/// Moves the columns of candidates out of a campaign.
v1::Campaign take_table(v1::Campaign& campaign) {
  v1::Campaign out;
  out.mutable_candidate_columns()->Swap(campaign.mutable_candidate_columns());
  out.mutable_candidate_attributes()->Swap(campaign.mutable_candidate_attributes());
  out.mutable_candidate_lubricants()->Swap(campaign.mutable_candidate_lubricants());
  return out;
}

/// Returns the points of a campaign, of a rig only the columns of its candidates.
v1::EvaluatePointsRequest points_request(const v1::Campaign& requested, v1::Campaign& table) {
  v1::EvaluatePointsRequest out;
  out.mutable_candidate_columns()->Swap(table.mutable_candidate_columns());
  if (requested.has_rig()) return out;
  out.set_lubricant(requested.lubricant());
  out.set_gear_set(requested.gear_set());
  out.set_surface(requested.surface());
  out.set_vehicle(requested.vehicle());
  if (requested.has_model_options()) *out.mutable_model_options() = requested.model_options();
  out.set_tolerance(requested.tolerance());
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
  std::set<std::string, std::less<>> out{"candidate", "condition", "row"};
  for (std::string& each : campaign_columns(requested)) out.insert(std::move(each));
  for (std::string& each : candidate_parameter_names()) out.insert(std::move(each));
  const auto& condition =
      requested.has_rig() ? *v1::RigCondition::descriptor() : *v1::PointCondition::descriptor();
  for (int i = 0; i < condition.field_count(); ++i) out.insert(condition.field(i)->name());
  return out;
}

void check_attributes(const v1::Campaign& requested, const v1::Campaign& table, int candidates,
                      Violations& violations) {
  auto taken = taken_names(requested);
  for (int i = 0; i < table.candidate_attributes_size(); ++i) {
    const v1::CandidateAttribute& each = table.candidate_attributes(i);
    const std::string path = fmt::format("candidate_attributes[{}]", i);
    if (!is_column_name(each.name())) {
      violations.add(path + ".name", "\"{}\"; allowed: 1 to {} letters, digits, '-', '_' and '.'",
                     plain_excerpt(each.name()), kMaximumAttributeName);
    } else if (!taken.insert(each.name()).second) {
      violations.add(path + ".name", "\"{}\" is the name of another column; choose another one",
                     each.name());
    }
    const int texts = each.texts_size(), numbers = each.values_size();
    if ((texts == 0) == (numbers == 0) || texts + numbers != candidates) {
      violations.add(path,
                     "{} texts and {} values; allowed: {} of one kind, one for each candidate",
                     texts, numbers, candidates);
    }
  }
}

void check_weights(const v1::Campaign& campaign, Violations& violations) {
  const int weights = campaign.condition_weights_size();
  const int conditions = condition_count(campaign);
  if (weights == 0 || weights == conditions) return;
  violations.add("condition_weights",
                 "{} weights; allowed: none, or one for each of the {} conditions", weights,
                 conditions);
}

/// Checks what read_points() does not see.
void check_rest(const v1::Campaign& requested, const v1::Campaign& table, Violations& violations) {
  v1::Campaign rest;
  rest.set_display_name(requested.display_name());
  *rest.mutable_condition_weights() = requested.condition_weights();
  if (requested.has_budget()) *rest.mutable_budget() = requested.budget();
  *rest.mutable_candidate_attributes() = table.candidate_attributes();
  *rest.mutable_candidate_lubricants() = table.candidate_lubricants();
  rest.set_lubricant_filter(requested.lubricant_filter());
  check_message(rest, "", violations);
  if (requested.labels_size() > kMaximumLabels) {
    violations.add("labels", "{} labels; allowed: at most {}", requested.labels_size(),
                   kMaximumLabels);
  } else {
    check_labels(requested.labels(), "labels", violations);
  }
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

/// Returns what a lubricant states of its boundary friction, which candidates have no columns of.
std::string boundary_text(const v1::Lubricant& lubricant) {
  v1::Lubricant out;
  *out.mutable_asperity_friction_by_temperature() = lubricant.asperity_friction_by_temperature();
  if (lubricant.has_asperity_friction_coefficient()) {
    out.set_asperity_friction_coefficient(lubricant.asperity_friction_coefficient());
  }
  if (lubricant.has_tribofilm_shear_strength_pascals()) {
    out.set_tribofilm_shear_strength_pascals(lubricant.tribofilm_shear_strength_pascals());
  }
  return out.SerializeAsString() + "\n";
}

/// The hash differs from that of any simulation: figures of screening are right within the same
/// tolerance, not the same to the last bit.
std::string hash_of(const CampaignInputs& inputs) {
  const PointEvaluation& points = inputs.points;
  Sha256 hash;
  hash.add("campaign by screening\n");
  hash.add(inputs.rig ? canonical_rig(inputs.requested, *inputs.rig)
                      : canonical_inputs(points.base));
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
  for (const auto& lubricant : points.lubricants) hash.add(boundary_text(*lubricant));
  if (points.with_contact) hash.add("contact figures\n");
  for (const Elasticity& each : points.elasticities) {
    hash.add("elasticity of " + each.figure + " by " + each.parameter + "\n");
  }
  return hash.finish();
}

[[noreturn]] void unreadable_request() {
  throw Refusal("STORED_REQUEST_UNREADABLE", "the stored request cannot be read");
}

/// Returns a stored campaign with a table of candidates, which may be empty, and with the revisions
/// of its resources.
v1::Campaign stored_request(const StoredCampaign& stored, const std::string& table) {
  v1::Campaign out;
  // Fields of the second message join those of the first.
  if (!out.ParseFromString(stored.request) || !out.MergeFromString(table)) unreadable_request();
  keep_first_candidates(stored.candidates, out);  // others may have been added since it was read
  // An older server may have accepted it with other defaults.
  out.set_lubricant(stored.revisions.lubricant);
  out.set_gear_set(stored.revisions.gear_set);
  out.set_surface(stored.revisions.surface);
  out.set_vehicle(stored.revisions.vehicle);
  return out;
}

/// Returns the candidates of a request for further ones: as columns, attributes and lubricants.
v1::Campaign further_candidates(const v1::Campaign& campaign, const v1::Campaign& present,
                                const v1::AppendCandidatesRequest& request,
                                const ResourceLookup& lookup, const ResourceLookup& accepted,
                                Violations& violations) {
  v1::Campaign out;
  if (present.candidate_columns().empty()) {
    violations.add("name",
                   "the campaign has one candidate, the base, and no columns that "
                   "further candidates could have; create another one");
    return out;
  }
  const bool is_of_lubricants = !present.candidate_lubricants().empty();
  if (is_of_lubricants == request.candidate_lubricants().empty()) {
    violations.add(
        is_of_lubricants ? "candidate_lubricants" : "candidate_lubricants[0]",
        is_of_lubricants
            ? "not set; allowed: lubricants, which the candidates of this campaign are"
            : "set; allowed: candidate_columns, which state the candidates of this campaign");
  }
  if (is_of_lubricants && !request.candidate_columns().empty()) {
    violations.add("candidate_columns",
                   "set; allowed: candidate_lubricants, as the candidates of this campaign "
                   "are lubricants");
  }
  if (!is_of_lubricants && request.candidate_columns().empty()) {
    violations.add("candidate_columns", "not set; allowed: those of the campaign");
  }
  if (!violations.empty()) return out;
  if (is_of_lubricants) {
    const auto base = find_resource<v1::Lubricant>(accepted, campaign.lubricant(), kLubricants,
                                                   "name", violations);
    if (!base) return out;
    out = lubricant_candidates(request.candidate_lubricants(), *base->resource, lookup, violations);
    const auto& known = present.candidate_lubricants();
    for (int i = 0; i < out.candidate_lubricants_size(); ++i) {
      const std::string& name = out.candidate_lubricants(i);
      if (std::find(known.begin(), known.end(), name) == known.end()) continue;
      violations.add(fmt::format("candidate_lubricants[{}]", i),
                     name + " is a candidate already; allowed: others");
    }
    if (known.size() + out.candidate_lubricants_size() > kMaximumCandidateLubricants) {
      violations.add("candidate_lubricants",
                     "{} beside the {} that it has; allowed: at most {} in one campaign",
                     out.candidate_lubricants_size(), known.size(), kMaximumCandidateLubricants);
    }
  }
  out.mutable_candidate_columns()->MergeFrom(request.candidate_columns());
  out.mutable_candidate_attributes()->MergeFrom(request.candidate_attributes());
  return out;
}

/// Returns the element with this name, or path; null if there is none.
template <class Elements>
auto* find_entry(Elements& elements, const std::string& name) {
  const auto name_of = [](const auto& each) -> const std::string& {
    if constexpr (requires { each.path(); }) {
      return each.path();
    } else {
      return each.name();
    }
  };
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const auto& each) { return name_of(each) == name; });
  return found == elements.end() ? nullptr : &*found;
}

/// Adds a violation for each column and attribute that only one of the two tables has.
void check_same_columns(const v1::Campaign& present, const v1::Campaign& further,
                        Violations& violations) {
  const auto is_optional = [&present](const std::string& name) {
    return !present.candidate_lubricants().empty() && is_made_attribute(name);
  };
  const auto kind = [](const v1::CandidateAttribute& each) {
    return each.texts().empty() ? "values" : "texts";
  };
  for (const v1::CandidateColumn& each : present.candidate_columns()) {
    if (find_entry(further.candidate_columns(), each.path()) != nullptr) continue;
    violations.add("candidate_columns", "lacks the column \"" + each.path() +
                                            "\" of the campaign; allowed: all of them");
  }
  for (int i = 0; i < further.candidate_columns_size(); ++i) {
    const std::string& path = further.candidate_columns(i).path();
    if (find_entry(present.candidate_columns(), path) != nullptr) continue;
    std::vector<std::string> known;
    for (const auto& each : present.candidate_columns()) known.push_back(each.path());
    violations.add(fmt::format("candidate_columns[{}].path", i),
                   "\"{}\" is no column of the campaign{}", plain_excerpt(path),
                   meant_text(path, known));
  }
  for (const v1::CandidateAttribute& each : present.candidate_attributes()) {
    const auto* other = find_entry(further.candidate_attributes(), each.name());
    if (is_optional(each.name()) || (other != nullptr && kind(*other) == kind(each))) continue;
    violations.add("candidate_attributes",
                   "lacks \"{}\" with {}; allowed: all attributes of the campaign", each.name(),
                   kind(each));
  }
  for (int i = 0; i < further.candidate_attributes_size(); ++i) {
    const std::string& name = further.candidate_attributes(i).name();
    if (is_optional(name) || find_entry(present.candidate_attributes(), name) != nullptr) continue;
    std::vector<std::string> known;
    for (const auto& each : present.candidate_attributes()) known.push_back(each.name());
    violations.add(fmt::format("candidate_attributes[{}].name", i),
                   "\"{}\" is no attribute of the campaign{}", plain_excerpt(name),
                   known.empty() ? ", which has none" : meant_text(name, known));
  }
}

/// Returns the candidates of both tables, which have the same columns. An uncertainty that only one
/// of them has is 0 in the other.
v1::Campaign joined_candidates(v1::Campaign present, v1::Campaign further) {
  const int before = present.candidate_columns(0).values_size();
  const int more = further.candidate_columns(0).values_size();
  for (v1::CandidateColumn& each : *present.mutable_candidate_columns()) {
    each.mutable_values()->MergeFrom(
        find_entry(further.candidate_columns(), each.path())->values());
  }
  for (v1::CandidateAttribute& each : *present.mutable_candidate_attributes()) {
    if (const auto* other = find_entry(further.candidate_attributes(), each.name())) {
      each.mutable_texts()->MergeFrom(other->texts());
      each.mutable_values()->MergeFrom(other->values());
    } else {
      each.mutable_values()->Resize(before + more, 0);
    }
  }
  for (v1::CandidateAttribute& each : *further.mutable_candidate_attributes()) {
    if (find_entry(present.candidate_attributes(), each.name()) != nullptr) continue;
    v1::CandidateAttribute& added = *present.add_candidate_attributes();
    added.set_name(each.name());
    added.mutable_values()->Resize(before, 0);
    added.mutable_values()->MergeFrom(each.values());
  }
  present.mutable_candidate_lubricants()->MergeFrom(further.candidate_lubricants());
  return present;
}

/// As read_campaign(), without input_hash, of a request whose candidates are columns.
std::optional<CampaignInputs> check_campaign(v1::Campaign request, const ResourceLookup& lookup,
                                             const std::string& path, Violations& violations) {
  Violations found;
  keep_client_part(request);
  CampaignInputs out;
  out.table = take_table(request);
  out.requested = std::move(request);
  const auto& columns = out.table.candidate_columns();
  check_attributes(out.requested, out.table, columns.empty() ? 1 : columns[0].values_size(), found);
  check_weights(out.requested, found);
  check_rest(out.requested, out.table, found);
  v1::EvaluatePointsRequest points = points_request(out.requested, out.table);
  const bool is_read = [&] {
    if (out.requested.has_rig()) {
      out.rig =
          read_rig_points(out.requested, points, lookup, kMaximumCampaignPoints, found, out.points);
      return out.rig.has_value();
    }
    auto read =
        read_points(points, lookup, found, kMaximumCampaignPoints, "in one campaign; make several");
    if (read) out.points = std::move(*read);
    return read.has_value();
  }();
  out.table.mutable_candidate_columns()->Swap(points.mutable_candidate_columns());
  for (Violation& each : found) {
    violations.add(join_path(path, each.field), std::move(each.description));
  }
  if (!is_read || !found.empty()) return std::nullopt;
  out.points.with_sentences = false;
  for (const std::string& name : out.table.candidate_lubricants()) {
    auto lubricant =
        find_resource<v1::Lubricant>(lookup, name, kLubricants, "candidate_lubricants", violations);
    if (!lubricant) return std::nullopt;
    out.points.lubricants.push_back(std::move(lubricant->resource));
  }
  out.columns = campaign_columns(out.requested).size();
  divide_groups(out.points);
  return out;
}

/// Adds a violation if the candidates take more than kMaximumCandidateBytes.
void check_size(const CampaignInputs& inputs, const std::string& path, Violations& violations) {
  const std::size_t bytes = inputs.table.ByteSizeLong();
  if (bytes <= kMaximumCandidateBytes) return;
  const auto candidates = static_cast<std::size_t>(inputs.points.candidates);
  violations.add(join_path(path, has_made_columns(inputs.requested) ? "candidate_attributes"
                                                                    : "candidate_columns"),
                 "{} candidates take {} bytes with their attributes; allowed: {} bytes in one "
                 "campaign, which {} such candidates take; make several",
                 candidates, bytes, kMaximumCandidateBytes,
                 candidates * kMaximumCandidateBytes / bytes);
}

}  // namespace

std::optional<CampaignInputs> read_campaign(v1::Campaign request, const ResourceLookup& lookup,
                                            const std::string& path, Violations& violations,
                                            const LubricantSearch& search) {
  keep_client_part(request);
  sort_labels(*request.mutable_labels());
  Violations found, rest;
  // Without lubricants there is no first one either, which is the base unless another is stated.
  const bool lacks_base = request.lubricant().empty() && !request.lubricant_filter().empty();
  make_candidates(request, lookup, search, found);
  // Without candidates the rest is checked too: the error lists all violations at once.
  if (!found.empty()) request.clear_candidate_attributes();  // there is nothing that they go with
  auto out = check_campaign(std::move(request), lookup, path, rest);
  std::set<std::string> fields;
  if (lacks_base) fields.insert(join_path(path, "lubricant"));
  for (Violation& each : found) {
    fields.insert(join_path(path, each.field));
    violations.add(join_path(path, each.field), std::move(each.description));
  }
  for (Violation& each : rest) {
    if (!fields.contains(each.field)) violations.push_back(std::move(each));
  }
  if (!found.empty() || !out) return std::nullopt;
  const std::size_t before = violations.size();
  check_size(*out, path, violations);
  if (violations.size() > before) return std::nullopt;
  out->input_hash = hash_of(*out);
  return out;
}

std::optional<AppendedCandidates> read_appended(const StoredCampaign& stored,
                                                const std::string& table,
                                                const v1::AppendCandidatesRequest& request,
                                                const ResourceLookup& lookup,
                                                const ResourceLookup& accepted,
                                                Violations& violations) {
  const std::size_t before = violations.size();
  const v1::Campaign campaign = stored_request(stored, {});
  v1::Campaign present;
  if (!present.ParseFromString(table)) unreadable_request();
  keep_first_candidates(stored.candidates, present);
  v1::Campaign further =
      further_candidates(campaign, present, request, lookup, accepted, violations);
  if (violations.size() > before) return std::nullopt;
  check_same_columns(present, further, violations);
  const auto count = [](const v1::Campaign& each) {
    return each.candidate_columns().empty() ? 0 : each.candidate_columns(0).values_size();
  };
  if (count(present) + count(further) > kMaximumCandidates) {
    violations.add("candidate_columns",
                   "{} candidates beside the {} that it has; allowed: at most "
                   "{} in one campaign; make another one",
                   count(further), count(present), kMaximumCandidates);
  }
  v1::Campaign part = campaign;
  part.MergeFrom(further);
  const auto own = check_campaign(std::move(part), accepted, "", violations);
  if (!own || violations.size() > before) return std::nullopt;
  AppendedCandidates out;
  out.cost_seconds = estimate_cost(*own).processor_seconds();
  out.candidate_lubricants = {further.candidate_lubricants().begin(),
                              further.candidate_lubricants().end()};
  v1::Campaign whole = campaign;
  whole.MergeFrom(joined_candidates(std::move(present), std::move(further)));
  auto all = check_campaign(std::move(whole), accepted, "", violations);
  if (all) check_size(*all, "", violations);
  if (!all || violations.size() > before) return std::nullopt;
  out.all = std::move(*all);
  out.all.input_hash = hash_of(out.all);
  return out;
}

CampaignInputs stored_campaign_inputs(const StoredCampaign& stored, const std::string& table,
                                      const ResourceLookup& lookup) {
  Violations violations;
  auto inputs = check_campaign(stored_request(stored, table), lookup, "campaign", violations);
  if (!inputs) {
    throw Refusal("STORED_REQUEST_INVALID",
                  violations.front().field + ": " + violations.front().description);
  }
  return std::move(*inputs);
}

void check_descriptions(const v1::Campaign& requested, const v1::Campaign& table, int candidates,
                        const std::string& path, Violations& violations) {
  Violations found;
  check_attributes(requested, table, candidates, found);
  check_weights(requested, found);
  check_rest(requested, table, found);
  for (Violation& each : found) {
    violations.add(join_path(path, each.field), std::move(each.description));
  }
}

v1::CostEstimate estimate_cost(const CampaignInputs& inputs) {
  if (inputs.rig) {
    return estimate_rig_cost(inputs.points.candidates, inputs.rig->groups.size(),
                             inputs.points.conditions);
  }
  return estimate_screening_cost(inputs.points);
}

}  // namespace tribodyn::server
