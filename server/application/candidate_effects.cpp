#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/decisions/factor_effects.h"
#include "server/application/campaign_decisions.h"
#include "server/application/campaigns.h"
#include "server/application/decision_table.h"
#include "server/application/errors.h"
#include "server/contract/check_message.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {
namespace {

constexpr double kDefaultCoverage = 0.95;

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
  std::vector<std::string> all, usual;  // usual: those that the model uses
  for (const v1::CandidateColumn& each : table.columns().table().candidate_columns()) {
    all.push_back(each.path());
    usual.push_back(each.path());
  }
  for (const v1::CandidateAttribute& each : table.columns().table().candidate_attributes()) {
    all.push_back(each.name());
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
                           request.coverage() == 0 ? kDefaultCoverage : request.coverage());
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
    for (const std::size_t other : each.collinear) {
      effect.add_collinear_columns(factors.columns[other]);
    }
  }
  table.add_warnings(candidates, *out.mutable_warnings());
  for (const auto& [factor, reason] : found->left_out) {
    v1::ColumnWithoutEffect& column = *out.add_left_out();
    column.set_column(factors.columns[factor]);
    column.set_reason(reason_message(reason));
  }
  return out;
}

}  // namespace tribodyn::server
