#include "server/application/rigs.h"

#include "core/refusal.h"
#include "server/application/errors.h"
#include "server/simulation/rig_evaluation.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {

Outcome<v1::EvaluateRigResponse> evaluate_rig(Application& application,
                                              const v1::EvaluateRigRequest& request,
                                              const CallContext& call) {
  Violations violations;
  const auto evaluation =
      read_rig(request, resource_lookup(application.store, call.project, call.limits), violations);
  if (!evaluation) return invalid(violations);
  try {
    return evaluate_rig(request, *evaluation, [&call] { return call.limits.are_over(); });
  } catch (const Cancelled&) {
    return call_over(call.limits);
  }
}

}  // namespace tribodyn::server
