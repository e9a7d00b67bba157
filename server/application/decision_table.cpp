#include "server/application/decision_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/study/warning_kinds.h"
#include "server/application/campaigns.h"
#include "server/contract/constraints.h"
#include "server/contract/resource_names.h"
#include "server/mapping/from_core.h"
#include "server/simulation/campaign_columns.h"
#include "server/support/value_of.h"

namespace tribodyn::server {
namespace {

constexpr std::int64_t kBlockRows = 65'536;  // rows of a column in memory: 0.5 MB

// Numbers of columns (campaign_columns.h), but for the first one of the axle.
constexpr int kRefusalNumber = 0;
constexpr int kFirstWithError = 1, kLeastTransmissionError = 6, kMostTransmissionError = 7;
constexpr int kRelativeError = 11;
static_assert(kCampaignColumns[kFirstWithError] == "pinion_torque_newton_metres");
static_assert(kCampaignColumns[kLeastTransmissionError] ==
              "dynamic_transmission_error_minimum_metres");
static_assert(kCampaignColumns[kMostTransmissionError] ==
              "dynamic_transmission_error_maximum_metres");
static_assert(kCampaignColumns[kRelativeError] == "estimated_relative_error");

/// Returns true if two campaigns have the same candidates, in the same order.
bool have_equal_candidates(FigureSource& one, FigureSource& other) {
  const auto candidates = [](FigureSource& source) {
    v1::Campaign out = source.columns.table();
    out.clear_candidate_attributes();
    out.set_lubricant_revision(source.stored.revisions.lubricant);
    return out.SerializeAsString();
  };
  return one.stored.candidates == other.stored.candidates && candidates(one) == candidates(other);
}

/// Calls visit(candidate, count) for all candidates, some at a time.
template <class Visit>
void visit_blocks(const StoredCampaign& stored, const Visit& visit) {
  const std::int64_t most = std::max<std::int64_t>(1, kBlockRows / stored.conditions);
  for (std::int64_t first = 0; first < stored.candidates; first += most) {
    visit(first, std::min<std::int64_t>(most, stored.candidates - first));
  }
}

/// Returns e.g. "at 20 to 60 km/h, sump -20 C": the range of the conditions with bit `n`, in what
/// differs between conditions. Empty if all have it.
std::string text_of_conditions(const std::vector<TableColumn>& columns,
                               const std::vector<std::uint32_t>& bits, std::size_t n) {
  static constexpr std::pair<std::string_view, std::string_view> kForms[] = {
      {"speed_kilometres_per_hour", "{} km/h"},
      {"ascent_angle_degrees", "slope {} degrees"},
      {"sump_temperature_celsius", "sump {} C"},
      {"inlet_temperature_rise_kelvin", "inlet rise {} K"},
      {"load_newtons", "{} N"},
      {"entrainment_speed_metres_per_second", "{} m/s"},
      {"slide_roll_ratio_percent", "slide-roll ratio {} %"},
      {"supply_temperature_celsius", "supply {} C"}};
  if (std::all_of(bits.begin(), bits.end(), [n](auto each) { return (each >> n & 1) != 0; })) {
    return {};
  }
  std::vector<std::string> parts;
  for (const TableColumn& column : columns) {
    const auto [least, most] = std::minmax_element(column.values.begin(), column.values.end());
    if (*least == *most) continue;
    double low = *most, high = *least;
    for (std::size_t k = 0; k < bits.size(); ++k) {
      if ((bits[k] >> n & 1) == 0) continue;
      low = std::min(low, column.values[k]);
      high = std::max(high, column.values[k]);
    }
    const std::string range = number_text(low) + (low == high ? "" : " to " + number_text(high));
    parts.push_back(
        fmt::format(fmt::runtime(value_of(kForms, std::string_view(column.name), "{}")), range));
  }
  return fmt::format("at {}", fmt::join(parts, ", "));
}

}  // namespace

void DecisionTable::set_weights(const google::protobuf::RepeatedField<double>& stated,
                                Violations& violations) {
  own_.weights = condition_weights(stated, own_.columns.request(), violations);
}

void DecisionTable::add(const v1::CandidateFigure& figure, const std::string& path,
                        Violations& violations) {
  FigureSource* source = find_source(figure.campaign(), path + ".campaign", violations);
  if (source == nullptr) return;
  TableColumns& columns = source->columns;
  const std::string name =
      figure.column().empty() ? usual_figure(columns.request()) : figure.column();
  auto column = columns.find(name);
  const bool is_figure =
      column && (column->kind == TableColumn::Kind::kPerCandidate ||
                 (column->kind == TableColumn::Kind::kStored && column->number != kRefusalNumber));
  if (!is_figure) {
    violations.add(path + ".column",
                   column
                       ? fmt::format("\"{}\" is no figure of candidates", plain_excerpt(name))
                       : fmt::format("no such column here{}", meant_text(name, columns.names())));
    return;
  }
  found_.push_back({std::move(*column), figure.aggregate(), source});
}

void DecisionTable::add(const v1::CandidateObjective& objective, const std::string& path,
                        Violations& violations) {
  add(objective.figure(), path + ".figure", violations);
}

void DecisionTable::add(
    const google::protobuf::RepeatedPtrField<v1::CandidateConstraint>& constraints,
    Violations& violations) {
  for (int i = 0; i < constraints.size(); ++i) {
    const std::string path = fmt::format("constraints[{}]", i);
    add(constraints[i].figure(), path + ".figure", violations);
    if (!constraints[i].has_minimum() && !constraints[i].has_maximum()) {
      violations.add(path + ".minimum", "not set; allowed: this, maximum or both");
    }
  }
}

CandidateSelection DecisionTable::read_all(
    const google::protobuf::RepeatedPtrField<v1::CandidateConstraint>& constraints) {
  // Read before the figures, because the campaign may run: rows written later count as missing.
  std::vector<bool> missing(static_cast<std::size_t>(own_.stored.candidates), false);
  add_missing(own_.stored, missing);
  for (FigureSource& each : others_) add_missing(each.stored, missing);
  for (const FoundFigure& each : found_) figures_.push_back(read(each));
  return select_candidates(missing, figures_, constraints);
}

template <class Visit>
void DecisionTable::visit_warnings(const Visit& visit) {
  const int column = own_.columns.find(std::string(kWarningBits))->number;
  const StoredCampaign& stored = own_.stored;
  const auto conditions = static_cast<std::size_t>(stored.conditions);
  visit_blocks(stored, [&](std::int64_t first, std::int64_t count) {
    const std::vector<double> bits = rows(stored, column, first, count);
    for (std::size_t row = 0; row < bits.size(); ++row) {
      if (!std::isfinite(bits[row])) continue;
      visit(static_cast<std::size_t>(first) + row / conditions, row % conditions,
            static_cast<std::uint32_t>(bits[row]));
    }
  });
}

std::vector<std::uint32_t> DecisionTable::warning_bits() {
  std::vector<std::uint32_t> out(static_cast<std::size_t>(own_.stored.candidates));
  visit_warnings([&out](std::size_t candidate, std::size_t /*condition*/, std::uint32_t bits) {
    out[candidate] |= bits;
  });
  return out;
}

bool DecisionTable::is_withheld(std::uint32_t warning_bits) {
  for (std::size_t n = 0; n < warning_kinds().size() && warning_bits >> n != 0; ++n) {
    if ((warning_bits >> n & 1) != 0 && withholds_verdict(warning_kinds()[n].code)) return true;
  }
  return false;
}

std::vector<v1::RefusedCandidate> DecisionTable::refused_candidates(int most) {
  const StoredCampaign& stored = own_.stored;
  const std::vector<CampaignRefusal> refusals =
      application_.store.campaign_refusals(stored.id, call_.limits);
  std::vector<v1::RefusedCandidate> out;
  visit_blocks(stored, [&](std::int64_t first, std::int64_t count) {
    const std::vector<double> numbers = rows(stored, kRefusalNumber, first, count);
    auto candidate = static_cast<std::size_t>(first);
    for (auto at = numbers.begin(); at != numbers.end(); at += stored.conditions, ++candidate) {
      const auto refused = std::find_if(at, at + stored.conditions, [](double n) { return n > 0; });
      if (refused == at + stored.conditions || static_cast<int>(out.size()) == most) continue;
      v1::RefusedCandidate& added = out.emplace_back();
      added.set_candidate(static_cast<int>(candidate));
      added.set_label(label(candidate));
      for (const CampaignRefusal& each : refusals) {
        if (each.number != static_cast<int>(*refused)) continue;
        added.mutable_refusal()->set_reason(each.reason);
        added.mutable_refusal()->set_message(each.message);
      }
    }
  });
  return out;
}

void DecisionTable::add_warnings(const std::vector<std::size_t>& candidates,
                                 google::protobuf::RepeatedPtrField<v1::CandidateWarning>& out) {
  constexpr int kMostNamed = 10'000;
  const StoredCampaign& stored = own_.stored;
  std::vector<bool> is_chosen(static_cast<std::size_t>(stored.candidates));
  for (const std::size_t each : candidates) is_chosen[each] = true;
  std::vector<std::uint32_t> of_candidates(is_chosen.size());
  std::vector<std::uint32_t> of_conditions(static_cast<std::size_t>(stored.conditions));
  visit_warnings([&](std::size_t candidate, std::size_t condition, std::uint32_t bits) {
    if (!is_chosen[candidate]) return;
    of_candidates[candidate] |= bits;
    of_conditions[condition] |= bits;
  });
  for (std::size_t n = 0; n < warning_kinds().size() && n < 32; ++n) {
    v1::CandidateWarning warning;
    for (const std::size_t each : candidates) {
      if ((of_candidates[each] >> n & 1) != 0 && warning.candidates_size() < kMostNamed) {
        warning.add_candidates(static_cast<int>(each));
      }
    }
    if (warning.candidates().empty()) continue;
    warning.set_code(std::string(warning_kinds()[n].code));
    set_kind(warning);
    warning.set_where(text_of_conditions(own_.columns.conditions(), of_conditions, n));
    *out.Add() = std::move(warning);
  }
}

const google::protobuf::RepeatedPtrField<std::string>* DecisionTable::texts(
    const std::string& attribute) {
  for (const v1::CandidateAttribute& each : own_.columns.table().candidate_attributes()) {
    if (each.name() == attribute && !each.texts().empty()) return &each.texts();
  }
  return nullptr;
}

std::string DecisionTable::label(std::size_t candidate) {
  const auto* names = texts(kNames);
  return names == nullptr ? "" : names->Get(static_cast<int>(candidate));
}

/// Returns the campaign of this name, own if it is empty. Returns null and adds a violation if
/// it does not exist or has other candidates.
FigureSource* DecisionTable::find_source(const std::string& name, const std::string& path,
                                         Violations& violations) {
  if (name.empty()) return &own_;
  const auto split = split_name(name);
  if (!split || (name.starts_with("projects/") && split->project != call_.project)) {
    violations.add(path, "\"{}\"; allowed: a campaign of the project {}", plain_excerpt(name),
                   call_.project);
    return nullptr;
  }
  auto stored = find_campaign(application_, std::string(split->relative), call_);
  if (!stored.ok()) {
    violations.add(path, plain_excerpt(name) + " does not exist");
    return nullptr;
  }
  if (stored.message().id == own_.stored.id) return &own_;
  for (FigureSource& each : others_) {
    if (each.stored.id == stored.message().id) return &each;
  }
  FigureSource& out = others_.emplace_back(application_, std::move(stored.message()), call_);
  if (!have_equal_candidates(own_, out)) {
    violations.add(path,
                   "the candidates of {} are not those of {}; allowed: a campaign with "
                   "the same lubricant and equal candidate_columns",
                   name_of(out.stored), name_of(own_.stored));
  }
  Violations none;
  out.weights = condition_weights({}, out.columns.request(), none);
  return &out;
}

std::vector<double> DecisionTable::rows(const StoredCampaign& stored, int column,
                                        std::int64_t candidate, std::int64_t count) {
  std::vector<double> out(
      static_cast<std::size_t>(count * stored.conditions),
      column == kRefusalNumber ? kNotComputed : std::numeric_limits<double>::quiet_NaN());
  application_.store.read_campaign(stored.id, column, candidate * stored.conditions, out,
                                   call_.limits);
  return out;
}

/// Marks the candidates of which a row is not computed.
void DecisionTable::add_missing(const StoredCampaign& stored, std::vector<bool>& missing) {
  visit_blocks(stored, [&](std::int64_t first, std::int64_t count) {
    const std::vector<double> numbers = rows(stored, kRefusalNumber, first, count);
    auto candidate = static_cast<std::size_t>(first);
    for (auto at = numbers.begin(); at != numbers.end(); at += stored.conditions, ++candidate) {
      if (std::count(at, at + stored.conditions, kNotComputed) > 0) missing[candidate] = true;
    }
  });
}

CandidateValues DecisionTable::read(const FoundFigure& figure) {
  if (figure.column.kind == TableColumn::Kind::kPerCandidate) return {figure.column.values, {}};
  const StoredCampaign& stored = figure.source->stored;
  const int column = figure.column.number;
  const bool has_errors = !figure.source->columns.request().has_rig() &&
                          column >= kFirstWithError && column <= kMostTransmissionError;
  const ConditionAggregate aggregate = DecisionTable::aggregate(figure);
  const auto conditions = static_cast<std::size_t>(stored.conditions);
  CandidateValues out;
  visit_blocks(stored, [&](std::int64_t first, std::int64_t count) {
    const std::vector<double> values = rows(stored, column, first, count);
    for (std::size_t at = 0; at < values.size(); at += conditions) {
      out.values.push_back(aggregate.value({values.data() + at, conditions}));
    }
    if (!has_errors) return;
    const std::vector<double> errors = solver_errors(stored, column, values, first, count);
    for (std::size_t at = 0; at < errors.size(); at += conditions) {
      out.solver_errors.push_back(aggregate.error({errors.data() + at, conditions}));
    }
  });
  return out;
}

/// Returns bounds of the solver's errors of some rows of a column.
std::vector<double> DecisionTable::solver_errors(const StoredCampaign& stored, int column,
                                                 const std::vector<double>& values,
                                                 std::int64_t first, std::int64_t count) {
  std::vector<double> out = rows(stored, kRelativeError, first, count);
  std::vector<double> other;  // the estimate is relative to the largest transmission error
  if (column == kLeastTransmissionError) other = rows(stored, kMostTransmissionError, first, count);
  if (column == kMostTransmissionError) other = rows(stored, kLeastTransmissionError, first, count);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double scale = std::max(std::abs(values[i]), other.empty() ? 0 : std::abs(other[i]));
    out[i] = std::isfinite(out[i]) ? out[i] * scale : 0;
  }
  return out;
}

std::vector<std::size_t> ordered(std::vector<std::size_t> candidates,
                                 const std::vector<double>& values, bool wants_most) {
  std::stable_sort(candidates.begin(), candidates.end(), [&](std::size_t a, std::size_t b) {
    return wants_most ? values[a] > values[b] : values[a] < values[b];
  });
  return candidates;
}

}  // namespace tribodyn::server
