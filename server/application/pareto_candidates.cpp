#include <set>
#include <vector>

#include "core/decisions/pareto_front.h"
#include "core/study/warning_kinds.h"
#include "server/application/campaign_decisions.h"
#include "server/application/campaigns.h"
#include "server/application/decision_table.h"
#include "server/application/errors.h"
#include "server/contract/check_message.h"

namespace tribodyn::server {
namespace {

constexpr int kMaximumFrontAnswer = 10'000;

}  // namespace

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
  if (!request.has_second()) violations.add("second", "not set");
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
  if (!table.is_of_rig()) out.set_not_included(kToothContactOnly);
  for (const std::size_t position : front) {
    const std::size_t candidate = selection.candidates[position];
    members.insert(candidate);
    if (out.candidates_size() < kMaximumFrontAnswer) {
      set_candidate(candidate, *out.add_candidates());
    }
  }
  table.add_warnings({members.begin(), members.end()}, *out.mutable_warnings());
  if (request.beaten_count() == 0) return out;
  for (const std::size_t candidate :
       ordered(selection.candidates, first, request.first().wants_most())) {
    if (out.beaten_candidates_size() == request.beaten_count()) break;
    if (!members.contains(candidate)) set_candidate(candidate, *out.add_beaten_candidates());
  }
  return out;
}

}  // namespace tribodyn::server
