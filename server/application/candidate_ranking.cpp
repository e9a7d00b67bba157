#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/decisions/ranking.h"
#include "core/refusal.h"
#include "core/study/warning_kinds.h"
#include "core/uncertainty/spread.h"
#include "server/application/campaign_decisions.h"
#include "server/application/campaign_messages.h"
#include "server/application/campaigns.h"
#include "server/application/decision_table.h"
#include "server/application/errors.h"
#include "server/application/page_token.h"
#include "server/application/paging.h"
#include "server/contract/check_message.h"
#include "server/simulation/candidate_uncertainty.h"
#include "server/simulation/input_deviations.h"
#include "server/storage/resource_lookup.h"
#include "server/support/text.h"

namespace tribodyn::server {
namespace {

constexpr int kDefaultCount = 20;
constexpr double kDefaultConfidence = 0.95;
constexpr int kMostRefused = 100;

/// How the best candidates compare with the best one.
struct Comparisons {
  DrawnCandidates drawn;
  /// Of the best candidates, in order; empty where no uncertainty is stated.
  std::vector<std::optional<v1::CandidateComparison>> of;
};

/// Returns how a candidate compares with the best one, by the draws that the model refuses of
/// neither.
std::optional<v1::CandidateComparison> comparison(const std::vector<double>& drawn,
                                                  const std::vector<double>& of_best, double stated,
                                                  double solver_error, double sign, int draws,
                                                  double confidence) {
  if (drawn.empty() || of_best.empty()) return std::nullopt;
  std::vector<double> own, better_by;
  for (std::size_t n = 0; n < drawn.size(); ++n) {
    if (!std::isfinite(drawn[n]) || !std::isfinite(of_best[n])) continue;
    own.push_back(drawn[n]);
    better_by.push_back(sign * (of_best[n] - drawn[n]) + solver_error);
  }
  const Spread spread = spread_of_draws(own, draws, stated);
  if (!std::isfinite(spread.standard_deviation)) return std::nullopt;
  v1::CandidateComparison out;
  out.set_standard_uncertainty(spread.standard_deviation);
  const bool is_best = &drawn == &of_best;
  out.set_worse_probability(is_best ? 0.5 : share_below_zero(better_by));
  out.set_tied(is_best || cannot_be_told_apart(out.worse_probability(), confidence));
  return out;
}

/// Compares the best candidates with the first one, as many as the points allow; of those before
/// the place `first` none. Throws Cancelled and Refusal.
Comparisons compare_best(Application& application, const v1::RankCandidatesRequest& request,
                         const std::vector<std::size_t>& best, std::size_t first,
                         const DecisionTable& table, const CallContext& call) {
  Comparisons out;
  const FoundFigure& figure = table.found(0);
  const StoredCampaign& stored = figure.source->stored;
  if (figure.column.kind != TableColumn::Kind::kStored || best.empty()) return out;
  const ConditionAggregate aggregate = DecisionTable::aggregate(figure);
  CandidateDraws draws{request, best, figure.column.number, aggregate, first};
  draws.candidates.resize(std::min(best.size(), kMaximumComparisonPoints / draws.points_of_each()));
  CampaignInputs inputs =
      stored_campaign_inputs(stored, application.store.candidate_table(stored.id, call.limits),
                             accepted_lookup(application.store, stored.project, stored.revisions));
  out.drawn = draws.compute(std::move(inputs), *application.gear_sets,
                            [&call] { return call.limits.are_over(); });
  const CandidateValues& values = table.figures().front();
  const auto solver_error = [&values](std::size_t candidate) {
    return values.solver_errors.empty() ? 0 : values.solver_errors[candidate];
  };
  for (std::size_t i = 0; i < draws.candidates.size(); ++i) {
    out.of.push_back(comparison(
        out.drawn.values[i], out.drawn.values[0], values.values[best[i]],
        solver_error(best[i]) + solver_error(best[0]), request.objective().wants_most() ? -1 : 1,
        out.drawn.draws, request.confidence() == 0 ? kDefaultConfidence : request.confidence()));
  }
  return out;
}

/// Where a page of a ranking begins, and what its ranking is of. A candidate whose rows are
/// computed keeps its place among the others, so that as many candidates with as many missing ones
/// are the same ranking.
struct RankingPage {
  std::size_t first = 0;
  std::int64_t candidates = 0;
  std::int64_t missing = 0;
};

/// What must not change between pages.
std::string ranking_scope(const v1::RankCandidatesRequest& request, const CallContext& call) {
  v1::RankCandidatesRequest same = request;
  same.clear_page_token();
  same.clear_count();
  return call.project + "\n" + same.SerializeAsString();
}

/// Returns nullopt, and adds a violation, if the request has no token of a ranking.
std::optional<RankingPage> requested_page(const std::string& key,
                                          const v1::RankCandidatesRequest& request,
                                          const CallContext& call, Violations& violations) {
  if (request.page_token().empty()) return std::nullopt;
  const auto token = parse_page_token(key, ranking_scope(request, call), request.page_token());
  const auto* first = token ? std::get_if<std::int64_t>(&token->last.value) : nullptr;
  const auto missing = token ? parse_number<std::int64_t>(token->last.name) : std::nullopt;
  if (first == nullptr || !missing) {
    add_bad_page_token(violations);
    return std::nullopt;
  }
  return RankingPage{static_cast<std::size_t>(*first), token->total, *missing};
}

google::rpc::Status ranking_changed(const std::string& name) {
  return aborted(v1::ERROR_REASON_RANKING_CHANGED, kCampaignType, name,
                 "candidates of " + name +
                     " were added or computed since the first page of the ranking; rank again "
                     "without page_token, once the campaign has ended or is paused",
                 false);
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
  const auto asked = requested_page(application.page_token_key, request, call, violations);
  DecisionTable table(application, stored.message(), call);
  table.set_weights(request.condition_weights(), violations);
  table.add(request.objective(), "objective", violations);
  table.add(request.constraints(), violations);
  if (!violations.empty()) return invalid(violations);
  const CandidateSelection selection = table.read_all(request.constraints());
  RankingPage page{0, stored.message().candidates, selection.missing};
  if (asked) {
    if (asked->candidates != page.candidates || asked->missing != page.missing) {
      return ranking_changed(request.name());
    }
    page.first = asked->first;
  }
  const CandidateValues& figure = table.figures().front();
  std::vector<std::size_t> best =
      ordered(selection.candidates, figure.values, request.objective().wants_most());
  const std::vector<std::uint32_t> warning_bits = table.warning_bits();
  const auto withheld = std::stable_partition(best.begin(), best.end(), [&](std::size_t each) {
    return !DecisionTable::is_withheld(warning_bits[each]);
  });
  const auto withheld_count = static_cast<int>(best.end() - withheld);
  std::vector<std::size_t> decided(best.begin(), withheld);
  const std::size_t end = std::min(
      best.size(), page.first + static_cast<std::size_t>(request.count() == 0 ? kDefaultCount
                                                                              : request.count()));
  decided.resize(std::min(decided.size(), end));
  try {
    const Comparisons comparisons =
        compare_best(application, request, decided, page.first, table, call);
    v1::RankCandidatesResponse out;
    out.set_withheld(withheld_count);
    out.set_draws(comparisons.drawn.draws);
    if (!table.is_of_rig()) out.set_not_included(kToothContactOnly);
    for (v1::RefusedCandidate& each : table.refused_candidates(kMostRefused)) {
      *out.add_refused_candidates() = std::move(each);
    }
    out.set_ranked(static_cast<int>(selection.candidates.size()));
    set_numbers(selection, out);
    out.set_compared(static_cast<int>(comparisons.of.size()));
    for (const std::string& each : comparisons.drawn.own_inputs) {
      out.add_own_uncertain_parameters(each);
    }
    for (const std::string& each : comparisons.drawn.shared_inputs) {
      out.add_shared_uncertain_parameters(each);
    }
    std::vector<std::size_t> shown;
    std::size_t bytes = 0;
    for (std::size_t i = page.first; i < end && bytes < kMaximumPageBytes; ++i) {
      shown.push_back(best[i]);
      v1::RankedCandidate& each = *out.add_candidates();
      each.set_candidate(static_cast<int>(best[i]));
      each.set_label(table.label(best[i]));
      each.set_value(figure.values[best[i]]);
      if (!figure.solver_errors.empty()) each.set_solver_error(figure.solver_errors[best[i]]);
      for (std::size_t k = 1; k < table.figures().size(); ++k) {
        each.add_constraint_values(table.figures()[k].values[best[i]]);
      }
      each.set_verdict_withheld(i >= decided.size());
      if (i < comparisons.of.size() && comparisons.of[i]) {
        *each.mutable_comparison() = *comparisons.of[i];
      }
      bytes += each.ByteSizeLong();
    }
    table.add_warnings(shown, *out.mutable_warnings());
    if (const std::size_t next = page.first + shown.size(); next < best.size()) {
      const PageStart last{static_cast<std::int64_t>(next), std::to_string(page.missing)};
      out.set_next_page_token(page_token(application.page_token_key, ranking_scope(request, call),
                                         {last, page.candidates}));
    }
    return out;
  } catch (const Cancelled&) {
    return call_over(call.limits);
  }
}

}  // namespace tribodyn::server
