#include "server/application/cycles.h"

#include "core/refusal.h"
#include "server/application/errors.h"
#include "server/simulation/cycle_evaluation.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {

Outcome<v1::EvaluateCycleResponse> evaluate_cycle(Application& application,
                                                  const v1::EvaluateCycleRequest& request,
                                                  const CallContext& call) {
  Violations violations;
  const auto evaluation = read_cycle(
      request, resource_lookup(application.store, call.project, call.limits), violations);
  if (!evaluation) return invalid(violations);
  try {
    return evaluate_cycle(request, *evaluation, *application.gear_sets,
                          [&call] { return call.limits.are_over(); });
  } catch (const Cancelled&) {
    return call_over(call.limits);
  }
}

}  // namespace tribodyn::server
