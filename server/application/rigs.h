#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/rigs.pb.h"

namespace tribodyn::server {

/// Computes all conditions of the request and returns their figures. Stores nothing.
Outcome<v1::EvaluateRigResponse> evaluate_rig(Application& application,
                                              const v1::EvaluateRigRequest& request,
                                              const CallContext& call);

}  // namespace tribodyn::server
