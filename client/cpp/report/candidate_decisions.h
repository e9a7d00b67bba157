#pragma once

#include <string>

#include "client/cpp/text/output.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::client {

/// Returns the column that is the figure of a candidate if a request names none.
const char* usual_column(const v1::Campaign& campaign);

// The answers about candidates of a campaign as texts. The figures of the requests name their
// columns.
std::string ranking_answer_text(const v1::RankCandidatesRequest& request,
                                const v1::RankCandidatesResponse& answer, OutputFormat format);
std::string front_answer_text(const v1::FindParetoCandidatesRequest& request,
                              const v1::FindParetoCandidatesResponse& answer, OutputFormat format);
std::string effects_answer_text(const v1::EstimateCandidateEffectsRequest& request,
                                const v1::EstimateCandidateEffectsResponse& answer,
                                OutputFormat format);

}  // namespace tribodyn::client
