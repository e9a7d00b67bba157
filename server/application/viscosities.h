#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/viscosities.pb.h"

namespace tribodyn::server {

/// Evaluates the laws of a lubricant. Stores nothing.
Outcome<v1::EvaluateViscosityResponse> evaluate_viscosity(
    Application& application, const v1::EvaluateViscosityRequest& request, const CallContext& call);

}  // namespace tribodyn::server
