#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/decisions/ranking.h"
#include "core/refusal.h"
#include "server/application/campaign_decisions.h"
#include "server/application/campaigns.h"
#include "server/application/decision_table.h"
#include "server/application/errors.h"
#include "server/contract/check_message.h"
#include "server/simulation/candidate_uncertainty.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {
namespace {

constexpr int kDefaultCount = 20;
constexpr double kDefaultConfidence = 0.95;

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
    inputs = stored_campaign_inputs(
        stored, application.store.candidate_table(stored.id, call.limits),
        accepted_lookup(application.store, stored.project, stored.revisions));
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
                          request.confidence() == 0 ? kDefaultConfidence : request.confidence());
  return out;
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

}  // namespace tribodyn::server
