#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::server {

/// Computes all points of the request and returns their figures. Stores nothing.
Outcome<v1::EvaluatePointsResponse> evaluate_points(Application& application,
                                                    const v1::EvaluatePointsRequest& request,
                                                    const CallContext& call = {});

/// Computes the points of the lubricants with the uncertainty of their inputs and returns their
/// differences. Stores nothing.
Outcome<v1::ComparePointsResponse> compare_points(Application& application,
                                                  const v1::ComparePointsRequest& request,
                                                  const CallContext& call = {});

/// Attributes the difference of two lubricants to groups of parameters. Stores nothing.
Outcome<v1::ExplainPointsResponse> explain_points(Application& application,
                                                  const v1::ExplainPointsRequest& request,
                                                  const CallContext& call = {});

}  // namespace tribodyn::server
