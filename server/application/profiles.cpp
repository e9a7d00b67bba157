#include "server/application/profiles.h"

#include <utility>

#include "core/refusal.h"
#include "server/application/errors.h"
#include "server/simulation/profile_evaluation.h"

namespace tribodyn::server {

Outcome<v1::EvaluateProfilesResponse> evaluate_profiles(Application& /*application*/,
                                                        const v1::EvaluateProfilesRequest& request,
                                                        const CallContext& call) {
  Violations violations;
  try {
    auto out = evaluate_profiles(
        request, [&call] { return call.limits.are_over(); }, violations);
    if (!out) return invalid(violations);
    return std::move(*out);
  } catch (const Cancelled&) {
    return call_over(call.limits);
  }
}

}  // namespace tribodyn::server
