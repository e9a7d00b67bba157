#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/profiles.pb.h"

namespace tribodyn::server {

/// Computes the surface of the profiles of the request by the sampling interval. Stores nothing.
Outcome<v1::EvaluateProfilesResponse> evaluate_profiles(Application& application,
                                                        const v1::EvaluateProfilesRequest& request,
                                                        const CallContext& call);

}  // namespace tribodyn::server
