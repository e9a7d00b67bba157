#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

// Decisions about the candidates of a campaign. All of them throw; the dispatcher guards them.

/// Returns the best candidates of a campaign and marks those that tie with the best one.
Outcome<v1::RankCandidatesResponse> rank_candidates(Application& application,
                                                    const v1::RankCandidatesRequest& request,
                                                    const CallContext& call = {});

/// Returns the candidates that no other one beats in both of two objectives.
Outcome<v1::FindParetoCandidatesResponse> find_pareto_candidates(
    Application& application, const v1::FindParetoCandidatesRequest& request,
    const CallContext& call = {});

/// Returns the effects of columns of candidates on a figure.
Outcome<v1::EstimateCandidateEffectsResponse> estimate_candidate_effects(
    Application& application, const v1::EstimateCandidateEffectsRequest& request,
    const CallContext& call = {});

/// Makes a candidate a lubricant and a surface.
Outcome<v1::PromoteCandidateResponse> promote_candidate(Application& application,
                                                        const v1::PromoteCandidateRequest& request,
                                                        const CallContext& call = {});

}  // namespace tribodyn::server
