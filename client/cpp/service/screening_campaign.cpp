#include "client/cpp/service/screening_campaign.h"

#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <set>

#include "client/cpp/resources/kind.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;

constexpr char kNames[] = "name";  // attribute with the candidates' names
constexpr char kUncertainty[] = ".uncertainty";
// Limits of CandidateAttribute and Campaign.
constexpr std::size_t kLongestAttributeName = 63, kLongestAttributeText = 200;
constexpr int kMostAttributes = 30;
// Values of conditions that a campaign leaves out, as PointCondition states them.
constexpr double kDefaultSumpCelsius = 40, kDefaultInletRiseKelvin = 20;

/// FNV-1a of 64 bits (Fowler, Noll and Vo): the same on every machine.
class Fnv {
 public:
  void add(const std::string& text) {
    for (const char c : text) mix(static_cast<unsigned char>(c));
    mix(0);  // "a", "bc" differs from "ab", "c"
  }
  std::string hex() const {
    std::string out(16, '0');
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = "0123456789abcdef"[(state_ >> (4 * (15 - i))) & 15U];
    }
    return out;
  }

 private:
  void mix(unsigned char byte) { state_ = (state_ ^ byte) * 0x100000001b3U; }
  std::uint64_t state_ = 0xcbf29ce484222325U;
};

/// Cuts a UTF-8 text to at most `most` bytes, at a code point.
std::string cut(std::string text, std::size_t most) {
  if (text.size() <= most) return text;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0U) == 0x80U) --most;
  text.resize(most);
  return text;
}

std::set<std::string> names_of_other_columns(const v1::Campaign& campaign) {
  const std::vector<std::string> figures = screened_columns(true);
  std::set<std::string> out(figures.begin(), figures.end());
  out.insert({"candidate", "condition", kNames});
  for (const FieldDescriptor* field : candidate_parameters()) {
    out.insert(CandidateParameter{field, {}}.path());
  }
  for (const v1::CandidateAttribute& each : campaign.candidate_attributes()) {
    out.insert(each.name());
  }
  const auto& condition = *v1::PointCondition::descriptor();
  for (int i = 0; i < condition.field_count(); ++i) out.insert(condition.field(i)->name());
  return out;
}

/// Returns the name of an attribute for a header that no other column has.
std::string attribute_name(const std::string& header, const v1::Campaign& campaign) {
  const std::string name = attribute_text(header);
  const std::set<std::string> taken = names_of_other_columns(campaign);
  std::string out = name;
  for (int i = 2; taken.contains(out); ++i) {
    const std::string end = "_" + std::to_string(i);
    out = name.substr(0, kLongestAttributeName - end.size()) + end;
  }
  return out;
}

std::optional<double> finite_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number =
      error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  return is_number ? std::optional(value) : std::nullopt;
}

/// Adds a carried column: as values if all of its cells are numbers, else as texts.
void add_attribute(const CandidateTable& table, const std::vector<std::size_t>& candidates,
                   std::size_t column, v1::Campaign& campaign) {
  v1::CandidateAttribute attribute;
  attribute.set_name(attribute_name(table.headers[column], campaign));
  for (const std::size_t i : candidates) {
    const auto value = finite_number(table.cells[i][column]);
    if (!value) break;
    attribute.add_values(*value);
  }
  if (attribute.values_size() != static_cast<int>(candidates.size())) {
    attribute.clear_values();
    for (const std::size_t i : candidates) {
      attribute.add_texts(cut(table.cells[i][column], kLongestAttributeText));
    }
  }
  *campaign.add_candidate_attributes() = std::move(attribute);
}

void add_attributes(const CandidateTable& table, const std::vector<std::size_t>& candidates,
                    v1::Campaign& campaign) {
  v1::CandidateAttribute& names = *campaign.add_candidate_attributes();
  names.set_name(kNames);
  for (const std::size_t i : candidates) {
    names.add_texts(cut(table.names[i], kLongestAttributeText));
  }
  for (const CandidateParameter& each : table.uncertainties) {
    const std::string name = each.field->name() + kUncertainty;
    if (name.size() > kLongestAttributeName) continue;
    v1::CandidateAttribute& attribute = *campaign.add_candidate_attributes();
    attribute.set_name(name);
    for (const std::size_t i : candidates) attribute.add_values(each.values[i]);
  }
  for (std::size_t k = 0; k < table.headers.size(); ++k) {
    if (campaign.candidate_attributes_size() == kMostAttributes) break;
    if (table.is_carried[k]) add_attribute(table, candidates, k, campaign);
  }
}

/// Adds a parameter that all candidates share with the base: without a column a campaign has one
/// candidate.
void add_equal_column(const CandidateBase& base, std::size_t candidates, v1::Campaign& campaign) {
  for (const FieldDescriptor* field : candidate_parameters()) {
    const double value = base_value(base, *field);
    if (!std::isfinite(value)) continue;
    v1::CandidateColumn& column = *campaign.add_candidate_columns();
    column.set_path(CandidateParameter{field, {}}.path());
    for (std::size_t i = 0; i < candidates; ++i) column.add_values(value);
    return;
  }
}

const FieldDescriptor* find_parameter_path(const std::string& path) {
  for (const FieldDescriptor* field : candidate_parameters()) {
    if (CandidateParameter{field, {}}.path() == path) return field;
  }
  return nullptr;
}

/// Returns the parameter of an attribute that states its uncertainty; null for any other attribute.
const FieldDescriptor* uncertain_parameter(const v1::CandidateAttribute& attribute) {
  for (const FieldDescriptor* field : candidate_parameters()) {
    if (attribute.name() == field->name() + kUncertainty && !attribute.values().empty()) {
      return field;
    }
  }
  return nullptr;
}

CandidateTable candidates_of(const v1::Campaign& campaign) {
  CandidateTable table;
  const auto count = static_cast<std::size_t>(campaign.candidates());
  for (std::size_t i = 0; i < count; ++i) table.names.push_back(std::to_string(i + 1));
  for (int i = 0; i < campaign.candidate_lubricants_size(); ++i) {
    table.names.at(static_cast<std::size_t>(i)) = resource_id(campaign.candidate_lubricants(i));
  }
  table.cells.resize(count);
  table.refusals.resize(count);
  const auto add_column = [&](const std::string& header, bool is_carried, const auto& cell) {
    table.headers.push_back(header);
    table.is_carried.push_back(is_carried);
    for (std::size_t i = 0; i < count; ++i) {
      table.cells[i].push_back(cell(static_cast<int>(i)));
    }
  };
  for (const v1::CandidateColumn& each : campaign.candidate_columns()) {
    const FieldDescriptor* field = find_parameter_path(each.path());
    if (field != nullptr) {
      CandidateParameter& parameter = table.parameters.emplace_back();
      parameter.field = field;
      parameter.values.assign(each.values().begin(), each.values().end());
      parameter.column = table.headers.size();
    }
    add_column(each.path(), field == nullptr, [&](int i) { return shortest(each.values(i)); });
  }
  for (const v1::CandidateAttribute& each : campaign.candidate_attributes()) {
    if (each.name() == kNames && !each.texts().empty()) {
      if (campaign.candidate_lubricants().empty()) {
        table.names.assign(each.texts().begin(), each.texts().end());
      }
    } else if (const FieldDescriptor* field = uncertain_parameter(each)) {
      table.uncertainties.push_back({field, {each.values().begin(), each.values().end()}});
    } else {
      add_column(each.name(), true, [&](int i) {
        return each.texts().empty() ? shortest(each.values(i)) : each.texts(i);
      });
    }
  }
  return table;
}

}  // namespace

std::string attribute_text(const std::string& header) {
  std::string out;
  for (const char c : header.substr(0, kLongestAttributeName)) {
    const bool is_allowed = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                            (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    out += is_allowed ? c : '_';
  }
  return out.empty() ? "_" : out;
}

v1::RankCandidatesResponse figures_ranking(Connection& connection,
                                           v1::RankCandidatesRequest request) {
  request.set_count(10'000);
  request.clear_uncertainties();
  request.set_ignore_stated_uncertainties(true);
  return connection.rank_candidates(request);
}

std::vector<std::size_t> accepted_candidates(const CandidateTable& table) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.refusals[i].empty()) out.push_back(i);
  }
  return out;
}

v1::Campaign campaign_without_candidates(const Screening& screening, const std::string& title) {
  const v1::EvaluatePointsRequest& base = screening.request;
  v1::Campaign out;
  out.set_display_name(cut(title, kLongestAttributeText));
  out.set_lubricant(base.lubricant());
  out.set_gear_set(base.gear_set());
  out.set_surface(base.surface());
  out.set_vehicle(base.vehicle());
  if (base.has_model_options()) *out.mutable_model_options() = base.model_options();
  out.set_tolerance(base.tolerance());
  out.set_contact_figures(base.contact_figures());
  *out.mutable_conditions() = base.conditions();
  const auto& weights = screening.weights;
  if (std::any_of(weights.begin(), weights.end(),
                  [&](double each) { return each != weights.front(); })) {
    *out.mutable_condition_weights() = {weights.begin(), weights.end()};
  }
  return out;
}

v1::Campaign campaign_of(const Screening& screening, const std::string& title) {
  v1::Campaign out = campaign_without_candidates(screening, title);
  const std::vector<std::size_t> candidates = accepted_candidates(screening.table);
  for (const CandidateParameter& parameter : screening.table.parameters) {
    v1::CandidateColumn& column = *out.add_candidate_columns();
    column.set_path(parameter.path());
    for (const std::size_t i : candidates) column.add_values(parameter.values[i]);
  }
  if (screening.table.parameters.empty()) add_equal_column(screening.bases, candidates.size(), out);
  add_attributes(screening.table, candidates, out);
  return out;
}

v1::AppendCandidatesRequest further_candidates(const Screening& screening,
                                               const v1::Campaign& campaign) {
  const v1::Campaign own = campaign_of(screening, "");
  const std::size_t count = accepted_candidates(screening.table).size();
  v1::AppendCandidatesRequest out;
  std::set<std::string> stated;
  if (!screening.table.parameters.empty()) {
    *out.mutable_candidate_columns() = own.candidate_columns();
    for (const v1::CandidateColumn& each : own.candidate_columns()) stated.insert(each.path());
  }
  for (const v1::CandidateColumn& each : campaign.candidate_columns()) {
    const FieldDescriptor* field = find_parameter_path(each.path());
    if (stated.contains(each.path()) || field == nullptr) continue;
    v1::CandidateColumn& column = *out.add_candidate_columns();
    column.set_path(each.path());
    const double value = base_value(screening.bases, *field);
    for (std::size_t i = 0; i < count; ++i) column.add_values(value);
  }
  const auto& known = campaign.candidate_attributes();
  const bool has_names = std::any_of(known.begin(), known.end(),
                                     [](const auto& each) { return each.name() == kNames; });
  for (const v1::CandidateAttribute& each : own.candidate_attributes()) {
    if (each.name() != kNames || has_names) *out.add_candidate_attributes() = each;
  }
  return out;
}

std::string screening_request_id(v1::Campaign campaign, const std::string& model_version) {
  campaign.clear_display_name();
  campaign.clear_labels();
  campaign.clear_condition_weights();
  campaign.clear_candidate_attributes();
  Fnv hash;
  hash.add(campaign.SerializeAsString());
  hash.add(model_version);
  return "screen-" + hash.hex();
}

v1::Campaign create_or_find(Connection& connection, v1::Campaign campaign,
                            const std::string& model_version) {
  CreateCampaignOptions create;
  create.request_id = screening_request_id(campaign, model_version);
  try {
    return connection.create_campaign(campaign, create);
  } catch (const ServiceError& error) {
    if (error.reason() != "REQUEST_ID_REUSED" || error.resource_name().empty()) throw;
    campaign.set_name(error.resource_name());
  }
  const v1::Campaign present = connection.get_campaign(campaign.name(), v1::CAMPAIGN_VIEW_FULL);
  std::vector<std::string> changed;
  const auto& columns = campaign.candidate_columns();
  const bool has_same_candidates =
      !columns.empty() && columns[0].values_size() == present.candidates();
  for (const std::string path :
       {"display_name", "labels", "condition_weights", "candidate_attributes"}) {
    if (path == "candidate_attributes" && !has_same_candidates) continue;
    const auto* field = v1::Campaign::descriptor()->FindFieldByName(path);
    google::protobuf::util::MessageDifferencer differencer;
    if (!differencer.CompareWithFields(present, campaign, {field}, {field})) {
      changed.emplace_back(path);
    }
  }
  campaign.clear_candidate_columns();  // up to 24 MB that do not change
  return changed.empty() ? present : connection.update_campaign(campaign, changed);
}

Screening screening_of(Connection& connection, const v1::Campaign& campaign) {
  Screening out;
  out.request.set_lubricant(campaign.lubricant_revision());
  out.request.set_gear_set(campaign.gear_set_revision());
  out.request.set_surface(campaign.surface_revision());
  out.request.set_vehicle(campaign.vehicle_revision());
  if (campaign.has_model_options()) *out.request.mutable_model_options() = campaign.model_options();
  out.request.set_tolerance(campaign.tolerance());
  out.request.set_contact_figures(campaign.contact_figures());
  for (v1::PointCondition condition : campaign.conditions()) {
    if (!condition.has_sump_temperature_celsius()) {
      condition.set_sump_temperature_celsius(kDefaultSumpCelsius);
    }
    if (!condition.has_inlet_temperature_rise_kelvin()) {
      condition.set_inlet_temperature_rise_kelvin(kDefaultInletRiseKelvin);
    }
    *out.request.add_conditions() = condition;
  }
  out.weights.assign(campaign.condition_weights().begin(), campaign.condition_weights().end());
  out.weights.resize(static_cast<std::size_t>(campaign.conditions_size()), 1);
  const double sum = std::accumulate(out.weights.begin(), out.weights.end(), 0.0);
  for (double& weight : out.weights) weight /= sum;
  out.base = connection.evaluate_points(out.request);
  out.bases.lubricant = connection.get<v1::Lubricant>(campaign.lubricant_revision());
  out.bases.surface = connection.get<v1::Surface>(campaign.surface_revision());
  out.table = candidates_of(campaign);
  return out;
}

void read_points(Connection& connection, const v1::Campaign& campaign, Screening& screening) {
  const std::vector<std::size_t> candidates = accepted_candidates(screening.table);
  const std::size_t conditions = screening.conditions();
  CampaignRowsOptions options;
  options.columns = screened_columns(screening.has_contact_figures());
  connection.stream_campaign(
      campaign.name(), options, [](const v1::HistorySchema&) {},
      [&](const HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.front().size(); ++i) {
          const std::size_t row = static_cast<std::size_t>(rows.first_row) + i;
          const std::size_t candidate = candidates.at(row / conditions);
          screening.points[candidate * conditions + row % conditions] =
              screened_point(rows.columns, i);
        }
      });
  screening.refusals.assign(campaign.refusals().begin(), campaign.refusals().end());
}

}  // namespace tribodyn::client
