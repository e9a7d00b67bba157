#include "server/application/viscosities.h"

#include "core/refusal.h"
#include "server/application/errors.h"
#include "server/simulation/viscosity_evaluation.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {

Outcome<v1::EvaluateViscosityResponse> evaluate_viscosity(
    Application& application, const v1::EvaluateViscosityRequest& request,
    const CallContext& call) {
  Violations violations;
  const auto evaluation = read_viscosity(
      request, resource_lookup(application.store, call.project, call.limits), violations);
  if (!evaluation) return invalid(violations);
  try {
    return evaluate_viscosity(request, *evaluation, [&call] { return call.limits.are_over(); });
  } catch (const Cancelled&) {
    return call_over(call.limits);
  }
}

}  // namespace tribodyn::server
