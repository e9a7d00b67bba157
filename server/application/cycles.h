#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/cycles.pb.h"

namespace tribodyn::server {

/// Adds up the mesh loss of all lubricants over the cycle of the request. Stores nothing.
Outcome<v1::EvaluateCycleResponse> evaluate_cycle(Application& application,
                                                  const v1::EvaluateCycleRequest& request,
                                                  const CallContext& call);

}  // namespace tribodyn::server
