#include "server/application/campaign_decisions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/decisions/factor_effects.h"
#include "core/decisions/pareto_front.h"
#include "core/decisions/ranking.h"
#include "core/refusal.h"
#include "server/application/campaigns.h"
#include "server/application/errors.h"
#include "server/application/table_columns.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/contract/resource_names.h"
#include "server/simulation/campaign_columns.h"
#include "server/simulation/candidate_figures.h"
#include "server/simulation/candidate_uncertainty.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {
namespace {

constexpr char kNames[] = "name";  // attribute with the candidates' names
constexpr char kUncertaintyEnd[] = ".uncertainty";
constexpr int kDefaultCount = 20;
constexpr double kDefaultProbability = 0.95;  // of confidence and coverage
constexpr int kMaximumFrontAnswer = 10'000;
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

/// A campaign that has figures of the candidates.
struct FigureSource {
  FigureSource(Application& application, StoredCampaign campaign, const CallContext& call)
      : stored(std::move(campaign)), columns(application, stored, call) {}
  const StoredCampaign stored;
  TableColumns columns;
  std::vector<double> weights;  ///< of its conditions
};

/// A figure of candidates, found in a campaign.
struct FoundFigure {
  TableColumn column;
  v1::CandidateFigure::Aggregate aggregate = v1::CandidateFigure::MEAN;
  FigureSource* source = nullptr;
};

/// Returns true if two campaigns have the same candidates, in the same order.
bool have_equal_candidates(FigureSource& one, FigureSource& other) {
  const auto candidates = [](FigureSource& source) {
    v1::Campaign out = source.columns.table();
    out.clear_candidate_attributes();
    out.set_lubricant_revision(source.stored.lubricant_revision);
    return out.SerializeAsString();
  };
  return one.stored.candidates == other.stored.candidates && candidates(one) == candidates(other);
}

/// Reads figures of the candidates of a campaign, and of others with the same candidates.
class DecisionTable {
 public:
  DecisionTable(Application& application, const StoredCampaign& stored, const CallContext& call)
      : application_(application), call_(call), own_(application, stored, call) {}

  /// Takes the weights of a request. Adds a violation if their number is wrong.
  void set_weights(const google::protobuf::RepeatedField<double>& stated, Violations& violations) {
    own_.weights = condition_weights(stated, own_.columns.request(), violations);
  }

  /// Adds a figure to those that read_all() reads; a violation if there is no such campaign or
  /// column.
  void add(const v1::CandidateFigure& figure, const std::string& path, Violations& violations) {
    FigureSource* source = find_source(figure.campaign(), path + ".campaign", violations);
    if (source == nullptr) return;
    TableColumns& columns = source->columns;
    const std::string name =
        figure.column().empty() ? usual_figure(columns.request()) : figure.column();
    auto column = columns.find(name);
    const bool is_figure =
        column &&
        (column->kind == TableColumn::Kind::kPerCandidate ||
         (column->kind == TableColumn::Kind::kStored && column->number != kRefusalNumber));
    if (!is_figure) {
      violations.push_back(
          {path + ".column",
           column ? fmt::format("\"{}\" is no figure of candidates", plain_excerpt(name))
                  : fmt::format("no such column here{}", meant_text(name, columns.names()))});
      return;
    }
    found_.push_back({std::move(*column), figure.aggregate(), source});
  }
  void add(const v1::CandidateObjective& objective, const std::string& path,
           Violations& violations) {
    add(objective.figure(), path + ".figure", violations);
  }
  void add(const google::protobuf::RepeatedPtrField<v1::CandidateConstraint>& constraints,
           Violations& violations) {
    for (int i = 0; i < constraints.size(); ++i) {
      const std::string path = fmt::format("constraints[{}]", i);
      add(constraints[i].figure(), path + ".figure", violations);
      if (!constraints[i].has_minimum() && !constraints[i].has_maximum()) {
        violations.push_back({path + ".minimum", "not set; allowed: this, maximum or both"});
      }
    }
  }

  /// Reads all figures, and selects the candidates that the constraints, the last figures, keep.
  CandidateSelection read_all(
      const google::protobuf::RepeatedPtrField<v1::CandidateConstraint>& constraints) {
    // Read before the figures, because the campaign may run: rows written later count as missing.
    std::vector<bool> missing(static_cast<std::size_t>(own_.stored.candidates), false);
    add_missing(own_.stored, missing);
    for (FigureSource& each : others_) add_missing(each.stored, missing);
    for (const FoundFigure& each : found_) figures_.push_back(read(each));
    return select_candidates(missing, figures_, constraints);
  }

  /// The figures of read_all(), in the order in which they were added.
  const std::vector<CandidateValues>& figures() const { return figures_; }
  const FoundFigure& found(std::size_t figure) const { return found_[figure]; }
  static ConditionAggregate aggregate(const FoundFigure& figure) {
    return {figure.aggregate, figure.source->weights};
  }
  TableColumns& columns() { return own_.columns; }

  /// Returns the texts of an attribute; nullopt if it has none or does not exist.
  const google::protobuf::RepeatedPtrField<std::string>* texts(const std::string& attribute) {
    for (const v1::CandidateAttribute& each : own_.columns.table().candidate_attributes()) {
      if (each.name() == attribute && !each.texts().empty()) return &each.texts();
    }
    return nullptr;
  }
  std::string label(std::size_t candidate) {
    const auto* names = texts(kNames);
    return names == nullptr ? "" : names->Get(static_cast<int>(candidate));
  }

 private:
  /// Returns the campaign of this name, own if it is empty. Returns null and adds a violation if
  /// it does not exist or has other candidates.
  FigureSource* find_source(const std::string& name, const std::string& path,
                            Violations& violations) {
    if (name.empty()) return &own_;
    const auto split = split_name(name);
    if (!split || (name.starts_with("projects/") && split->project != call_.project)) {
      violations.push_back({path, fmt::format("\"{}\"; allowed: a campaign of the project {}",
                                              plain_excerpt(name), call_.project)});
      return nullptr;
    }
    auto stored = find_campaign(application_, std::string(split->relative), call_);
    if (!stored.ok()) {
      violations.push_back({path, plain_excerpt(name) + " does not exist"});
      return nullptr;
    }
    if (stored.message().id == own_.stored.id) return &own_;
    for (FigureSource& each : others_) {
      if (each.stored.id == stored.message().id) return &each;
    }
    FigureSource& out = others_.emplace_back(application_, std::move(stored.message()), call_);
    if (!have_equal_candidates(own_, out)) {
      violations.push_back(
          {path, fmt::format("the candidates of {} are not those of {}; allowed: a campaign with "
                             "the same lubricant and equal candidate_columns",
                             name_of(out.stored), name_of(own_.stored))});
    }
    Violations none;
    out.weights = condition_weights({}, out.columns.request(), none);
    return &out;
  }

  /// Calls visit(candidate, count) for all candidates, some at a time.
  template <class Visit>
  static void visit_blocks(const StoredCampaign& stored, const Visit& visit) {
    const std::int64_t most = std::max<std::int64_t>(1, kBlockRows / stored.conditions);
    for (std::int64_t first = 0; first < stored.candidates; first += most) {
      visit(first, std::min<std::int64_t>(most, stored.candidates - first));
    }
  }
  std::vector<double> rows(const StoredCampaign& stored, int column, std::int64_t candidate,
                           std::int64_t count) {
    std::vector<double> out(
        static_cast<std::size_t>(count * stored.conditions),
        column == kRefusalNumber ? kNotComputed : std::numeric_limits<double>::quiet_NaN());
    application_.store.read_campaign(stored.id, column, candidate * stored.conditions, out,
                                     call_.limits);
    return out;
  }

  /// Marks the candidates of which a row is not computed.
  void add_missing(const StoredCampaign& stored, std::vector<bool>& missing) {
    visit_blocks(stored, [&](std::int64_t first, std::int64_t count) {
      const std::vector<double> numbers = rows(stored, kRefusalNumber, first, count);
      auto candidate = static_cast<std::size_t>(first);
      for (auto at = numbers.begin(); at != numbers.end(); at += stored.conditions, ++candidate) {
        if (std::count(at, at + stored.conditions, kNotComputed) > 0) missing[candidate] = true;
      }
    });
  }

  CandidateValues read(const FoundFigure& figure) {
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
  std::vector<double> solver_errors(const StoredCampaign& stored, int column,
                                    const std::vector<double>& values, std::int64_t first,
                                    std::int64_t count) {
    std::vector<double> out = rows(stored, kRelativeError, first, count);
    std::vector<double> other;  // the estimate is relative to the largest transmission error
    if (column == kLeastTransmissionError)
      other = rows(stored, kMostTransmissionError, first, count);
    if (column == kMostTransmissionError)
      other = rows(stored, kLeastTransmissionError, first, count);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double scale = std::max(std::abs(values[i]), other.empty() ? 0 : std::abs(other[i]));
      out[i] = std::isfinite(out[i]) ? out[i] * scale : 0;
    }
    return out;
  }

  Application& application_;
  const CallContext& call_;
  FigureSource own_;
  std::deque<FigureSource> others_;
  std::vector<FoundFigure> found_;
  std::vector<CandidateValues> figures_;
};

/// How the best candidates compare with the best one.
struct Comparisons {
  std::vector<UncertainParameter> parameters;
  std::vector<std::optional<v1::CandidateComparison>> of;  ///< of the best candidates, in order
};

/// Returns the comparisons of candidates with the first one. `effects`: by candidate and parameter.
std::vector<std::optional<v1::CandidateComparison>> comparisons_of(
    const std::vector<std::size_t>& candidates, const CandidateValues& figure, double sign,
    const std::vector<UncertainParameter>& parameters,
    const std::vector<std::vector<double>>& effects, double confidence) {
  std::vector<std::optional<v1::CandidateComparison>> out(candidates.size());
  std::vector<std::size_t> whole;  // positions of candidates with all effects
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool is_whole = std::all_of(effects[i].begin(), effects[i].end(),
                                      [](double each) { return std::isfinite(each); });
    if (is_whole) whole.push_back(i);
  }
  if (whole.empty() || whole.front() != 0) return out;  // nothing to compare with
  const auto shared = std::count_if(parameters.begin(), parameters.end(),
                                    [](const auto& each) { return each.is_shared; });
  const auto rows = static_cast<Eigen::Index>(whole.size());
  UncertainCandidates compared{
      Eigen::VectorXd(rows), Eigen::VectorXd::Zero(rows),
      Eigen::MatrixXd(rows, static_cast<Eigen::Index>(parameters.size()) - shared),
      Eigen::MatrixXd(rows, shared)};
  for (Eigen::Index row = 0; row < rows; ++row) {
    const std::size_t position = whole[static_cast<std::size_t>(row)];
    const std::size_t candidate = candidates[position];
    compared.values(row) = sign * figure.values[candidate];
    if (!figure.solver_errors.empty())
      compared.solver_errors(row) = figure.solver_errors[candidate];
    Eigen::Index next_own = 0, next_shared = 0;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (parameters[k].is_shared) {
        compared.shared_effects(row, next_shared++) = sign * effects[position][k];
      } else {
        compared.own_effects(row, next_own++) = sign * effects[position][k];
      }
    }
  }
  for (const tribodyn::RankedCandidate& each : ranked_candidates(compared, confidence)) {
    const std::size_t position = whole[static_cast<std::size_t>(each.index)];
    double variance = 0;
    for (const double effect : effects[position]) variance += effect * effect;
    v1::CandidateComparison& comparison = out[position].emplace();
    comparison.set_standard_uncertainty(std::sqrt(variance));
    comparison.set_worse_probability(each.to_best.higher_probability);
    comparison.set_tied(each.is_tied);
  }
  return out;
}

/// Compares the best candidates with the first one, as many as the points allow. Throws Cancelled
/// and Refusal.
Comparisons compare_best(Application& application, const v1::RankCandidatesRequest& request,
                         const std::vector<std::size_t>& best, const DecisionTable& table,
                         const CallContext& call) {
  Comparisons out;
  const FoundFigure& figure = table.found(0);
  const StoredCampaign& stored = figure.source->stored;
  const bool is_computed = figure.column.kind == TableColumn::Kind::kStored;
  std::optional<CampaignInputs> inputs;
  if (is_computed && !best.empty()) {
    const std::vector<std::string> revisions = {stored.lubricant_revision, stored.gear_set_revision,
                                                stored.surface_revision, stored.vehicle_revision};
    inputs =
        stored_campaign_inputs(stored, application.store.candidate_table(stored.id, call.limits),
                               accepted_lookup(application.store, stored.project, revisions));
    out.parameters = uncertain_parameters(request, *inputs);
  }
  std::size_t count = best.size();
  if (!out.parameters.empty()) {
    const std::size_t points =
        2 * out.parameters.size() * static_cast<std::size_t>(stored.conditions);
    count = std::min(count, kMaximumComparisonPoints / points);
  }
  const std::vector<std::size_t> compared(best.begin(),
                                          best.begin() + static_cast<std::ptrdiff_t>(count));
  std::vector<std::vector<double>> effects(count);
  if (!out.parameters.empty() && count > 0) {
    const ConditionAggregate aggregate = DecisionTable::aggregate(figure);
    const EffectsStudy study{out.parameters, compared, figure.column.number, aggregate};
    effects = study.compute(std::move(*inputs), *application.gear_sets,
                            [&call] { return call.limits.are_over(); });
  }
  out.of = comparisons_of(compared, table.figures().front(),
                          request.objective().wants_most() ? -1 : 1, out.parameters, effects,
                          request.confidence() == 0 ? kDefaultProbability : request.confidence());
  return out;
}

/// Returns candidates by a figure, the best first, equal ones in their order.
std::vector<std::size_t> ordered(std::vector<std::size_t> candidates,
                                 const std::vector<double>& values, bool wants_most) {
  std::stable_sort(candidates.begin(), candidates.end(), [&](std::size_t a, std::size_t b) {
    return wants_most ? values[a] > values[b] : values[a] < values[b];
  });
  return candidates;
}

template <class Response>
void set_numbers(const CandidateSelection& selection, Response& out) {
  out.set_excluded(selection.excluded);
  out.set_refused(selection.refused);
  out.set_missing(selection.missing);
}

/// The factors of a linear model, and the names of their columns.
struct EffectFactors {
  std::vector<std::string> columns;
  std::vector<Factor> factors;  // by candidate of the campaign
};

void add_factor(DecisionTable& table, const std::string& name, EffectFactors& out) {
  Factor& factor = out.factors.emplace_back();
  out.columns.push_back(name);
  if (const auto* texts = table.texts(name)) {
    factor.words.assign(texts->begin(), texts->end());
  } else {
    factor.numbers = table.columns().find(name)->values;
  }
}

EffectFactors effect_factors(DecisionTable& table,
                             const v1::EstimateCandidateEffectsRequest& request,
                             Violations& violations) {
  std::vector<std::string> all, usual;
  for (const v1::CandidateColumn& each : table.columns().table().candidate_columns()) {
    all.push_back(each.path());
    usual.push_back(each.path());
  }
  for (const v1::CandidateAttribute& each : table.columns().table().candidate_attributes()) {
    all.push_back(each.name());
    if (each.name() != kNames && !each.name().ends_with(kUncertaintyEnd)) {
      usual.push_back(each.name());
    }
  }
  EffectFactors out;
  for (int i = 0; i < request.columns_size(); ++i) {
    const std::string& name = request.columns(i);
    if (std::find(all.begin(), all.end(), name) == all.end()) {
      violations.push_back(
          {fmt::format("columns[{}]", i), fmt::format("\"{}\" is no column of the candidates{}",
                                                      plain_excerpt(name), meant_text(name, all))});
    } else if (std::find(out.columns.begin(), out.columns.end(), name) == out.columns.end()) {
      add_factor(table, name, out);
    }
  }
  if (request.columns().empty()) {
    for (const std::string& name : usual) add_factor(table, name, out);
  }
  return out;
}

/// Keeps of each factor what it has of the selected candidates.
void keep_candidates(const std::vector<std::size_t>& candidates, EffectFactors& out) {
  for (Factor& factor : out.factors) {
    Factor kept;
    for (const std::size_t each : candidates) {
      if (factor.numbers.empty()) {
        kept.words.push_back(factor.words[each]);
      } else {
        kept.numbers.push_back(factor.numbers[each]);
      }
    }
    factor = std::move(kept);
  }
}

v1::ColumnWithoutEffect::Reason reason_message(NoEffect reason) {
  switch (reason) {
    case NoEffect::kConstant:
      return v1::ColumnWithoutEffect::CONSTANT;
    case NoEffect::kTooManyWords:
      return v1::ColumnWithoutEffect::TOO_MANY_TEXTS;
    case NoEffect::kFollowsFromOthers:
      break;
  }
  return v1::ColumnWithoutEffect::FOLLOWS_FROM_OTHERS;
}

}  // namespace

Outcome<v1::RankCandidatesResponse> rank_candidates(Application& application,
                                                    const v1::RankCandidatesRequest& request,
                                                    const CallContext& call) {
  const auto stored = find_campaign(application, request.name(), call);
  if (!stored.ok()) return stored.error();
  Violations violations;
  check_message(request, "", violations);
  check_uncertainties(request, violations);
  DecisionTable table(application, stored.message(), call);
  table.set_weights(request.condition_weights(), violations);
  table.add(request.objective(), "objective", violations);
  table.add(request.constraints(), violations);
  if (!violations.empty()) return invalid(violations);
  const CandidateSelection selection = table.read_all(request.constraints());
  const CandidateValues& figure = table.figures().front();
  std::vector<std::size_t> best =
      ordered(selection.candidates, figure.values, request.objective().wants_most());
  best.resize(std::min(best.size(), static_cast<std::size_t>(
                                        request.count() == 0 ? kDefaultCount : request.count())));
  try {
    const Comparisons comparisons = compare_best(application, request, best, table, call);
    v1::RankCandidatesResponse out;
    out.set_ranked(static_cast<int>(selection.candidates.size()));
    set_numbers(selection, out);
    out.set_compared(static_cast<int>(comparisons.of.size()));
    for (const UncertainParameter& each : comparisons.parameters) {
      (each.is_shared ? out.add_shared_uncertain_parameters() : out.add_own_uncertain_parameters())
          ->assign(each.path);
    }
    for (std::size_t i = 0; i < best.size(); ++i) {
      v1::RankedCandidate& each = *out.add_candidates();
      each.set_candidate(static_cast<int>(best[i]));
      each.set_label(table.label(best[i]));
      each.set_value(figure.values[best[i]]);
      if (!figure.solver_errors.empty()) each.set_solver_error(figure.solver_errors[best[i]]);
      for (std::size_t k = 1; k < table.figures().size(); ++k) {
        each.add_constraint_values(table.figures()[k].values[best[i]]);
      }
      if (i < comparisons.of.size() && comparisons.of[i]) {
        *each.mutable_comparison() = *comparisons.of[i];
      }
    }
    return out;
  } catch (const Cancelled&) {
    return call_over(call.limits);
  }
}

Outcome<v1::FindParetoCandidatesResponse> find_pareto_candidates(
    Application& application, const v1::FindParetoCandidatesRequest& request,
    const CallContext& call) {
  const auto stored = find_campaign(application, request.name(), call);
  if (!stored.ok()) return stored.error();
  Violations violations;
  check_message(request, "", violations);
  DecisionTable table(application, stored.message(), call);
  table.set_weights(request.condition_weights(), violations);
  table.add(request.first(), "first", violations);
  table.add(request.second(), "second", violations);
  if (!request.has_second()) violations.push_back({"second", "not set"});
  table.add(request.constraints(), violations);
  if (!violations.empty()) return invalid(violations);
  const CandidateSelection selection = table.read_all(request.constraints());
  const std::vector<double>& first = table.figures()[0].values;
  const std::vector<double>& second = table.figures()[1].values;
  std::vector<double> of_first, of_second;
  for (const std::size_t each : selection.candidates) {
    of_first.push_back(request.first().wants_most() ? -first[each] : first[each]);
    of_second.push_back(request.second().wants_most() ? -second[each] : second[each]);
  }
  v1::FindParetoCandidatesResponse out;
  set_numbers(selection, out);
  const std::vector<std::size_t> front = pareto_front(of_first, of_second);
  out.set_total_size(static_cast<int>(front.size()));
  out.set_beaten(static_cast<int>(selection.candidates.size() - front.size()));
  const auto set_candidate = [&](std::size_t candidate, v1::ParetoCandidate& each) {
    each.set_candidate(static_cast<int>(candidate));
    each.set_label(table.label(candidate));
    each.set_first_value(first[candidate]);
    each.set_second_value(second[candidate]);
  };
  std::set<std::size_t> members;
  for (const std::size_t position : front) {
    const std::size_t candidate = selection.candidates[position];
    members.insert(candidate);
    if (out.candidates_size() < kMaximumFrontAnswer) {
      set_candidate(candidate, *out.add_candidates());
    }
  }
  if (request.beaten_count() == 0) return out;
  for (const std::size_t candidate :
       ordered(selection.candidates, first, request.first().wants_most())) {
    if (out.beaten_candidates_size() == request.beaten_count()) break;
    if (!members.contains(candidate)) set_candidate(candidate, *out.add_beaten_candidates());
  }
  return out;
}

Outcome<v1::EstimateCandidateEffectsResponse> estimate_candidate_effects(
    Application& application, const v1::EstimateCandidateEffectsRequest& request,
    const CallContext& call) {
  const auto stored = find_campaign(application, request.name(), call);
  if (!stored.ok()) return stored.error();
  Violations violations;
  check_message(request, "", violations);
  DecisionTable table(application, stored.message(), call);
  table.set_weights(request.condition_weights(), violations);
  table.add(request.figure(), "figure", violations);
  table.add(request.constraints(), violations);
  EffectFactors factors = effect_factors(table, request, violations);
  if (!violations.empty()) return invalid(violations);
  const CandidateSelection selection = table.read_all(request.constraints());
  const std::vector<std::size_t>& candidates = selection.candidates;
  keep_candidates(candidates, factors);
  std::vector<double> response;
  for (const std::size_t each : candidates) {
    response.push_back(table.figures().front().values[each]);
  }
  const auto found =
      response.empty()
          ? std::nullopt
          : factor_effects(factors.factors, response,
                           request.coverage() == 0 ? kDefaultProbability : request.coverage());
  if (!found) {
    return invalid({{"columns", fmt::format("{} candidates have the figure, too few for as many "
                                            "columns; allowed: columns whose coefficients are "
                                            "fewer than the candidates by two",
                                            candidates.size())}});
  }
  v1::EstimateCandidateEffectsResponse out;
  set_numbers(selection, out);
  out.set_candidates(static_cast<int>(candidates.size()));
  out.set_degrees_of_freedom(found->degrees_of_freedom);
  out.set_residual_standard_deviation_value(found->residual_standard_deviation);
  out.set_explained_share(found->explained_share);
  for (const FactorEffect& each : found->effects) {
    v1::CandidateEffect& effect = *out.add_effects();
    effect.set_column(factors.columns[each.factor]);
    effect.set_from_candidate(static_cast<int>(candidates[each.from]));
    effect.set_to_candidate(static_cast<int>(candidates[each.to]));
    effect.set_effect(each.effect);
    effect.set_effect_minimum(each.low);
    effect.set_effect_maximum(each.high);
  }
  for (const auto& [factor, reason] : found->left_out) {
    v1::ColumnWithoutEffect& column = *out.add_left_out();
    column.set_column(factors.columns[factor]);
    column.set_reason(reason_message(reason));
  }
  return out;
}

}  // namespace tribodyn::server
