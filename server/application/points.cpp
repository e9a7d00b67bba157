#include "server/application/points.h"

#include "core/refusal.h"
#include "server/application/errors.h"
#include "server/simulation/point_comparison.h"
#include "server/simulation/point_evaluation.h"
#include "server/simulation/point_explanation.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {

Outcome<v1::EvaluatePointsResponse> evaluate_points(Application& application,
                                                    const v1::EvaluatePointsRequest& request,
                                                    const CallContext& call) {
  Violations violations;
  const auto lookup = resource_lookup(application.store, call.project, call.limits);
  const auto evaluation =
      request.elasticity_parameters().empty()
          ? read_points(request, lookup, violations)
          : read_points(request, lookup, violations, kMaximumDifferentiatedPoints,
                        "with elasticities in one request; send several");
  if (!evaluation) return invalid(violations);
  try {
    return evaluate_points(*evaluation, *application.gear_sets,
                           [&call] { return call.limits.are_over(); });
  } catch (const Cancelled&) {
    return call_over(call.limits);
  }
}

Outcome<v1::ComparePointsResponse> compare_points(Application& application,
                                                  const v1::ComparePointsRequest& request,
                                                  const CallContext& call) {
  Violations violations;
  const auto comparison = read_comparison(
      request, resource_lookup(application.store, call.project, call.limits), violations);
  if (!comparison) return invalid(violations);
  try {
    return compare_points(*comparison, *application.gear_sets,
                          [&call] { return call.limits.are_over(); });
  } catch (const Cancelled&) {
    return call_over(call.limits);
  }
}

Outcome<v1::ExplainPointsResponse> explain_points(Application& application,
                                                  const v1::ExplainPointsRequest& request,
                                                  const CallContext& call) {
  Violations violations;
  const auto explanation = read_explanation(
      request, resource_lookup(application.store, call.project, call.limits), violations);
  if (!explanation) return invalid(violations);
  try {
    return explain_points(*explanation, *application.gear_sets,
                          [&call] { return call.limits.are_over(); });
  } catch (const Cancelled&) {
    return call_over(call.limits);
  }
}

}  // namespace tribodyn::server
