#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "client/cpp/text/output.h"
#include "client/cpp/text/warnings.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::client {

/// Returns the column that is the figure of a candidate if a request names none.
const char* usual_column(const v1::Campaign& campaign);

/// Returns why a column has no effect, e.g. "the same for all".
const char* reason_text(v1::ColumnWithoutEffect::Reason reason);

/// Returns e.g. "all 5 candidates", "3 best of 5 candidates" where `best` is " best".
std::string best_of_text(std::size_t shown, std::size_t all, const char* best);

/// Returns the warnings of a ranking with the names of the candidates that have them.
std::vector<ShownWarning> ranking_warnings(const v1::RankCandidatesResponse& answer);
/// Returns what the figures leave out, and the warnings; begins with an empty line.
std::string ranking_notes(const v1::RankCandidatesResponse& answer);

// The answers about candidates of a campaign as texts. The figures of the requests name their
// columns. `ranking`: a ranking of the same candidates, with their warnings. The texts of tables
// do not list these: see ranking_notes().
std::string ranking_answer_text(const v1::RankCandidatesRequest& request,
                                const v1::RankCandidatesResponse& answer, OutputFormat format);
std::string front_answer_text(const v1::FindParetoCandidatesRequest& request,
                              const v1::FindParetoCandidatesResponse& answer,
                              const v1::RankCandidatesResponse& ranking, OutputFormat format);
std::string effects_answer_text(const v1::EstimateCandidateEffectsRequest& request,
                                const v1::EstimateCandidateEffectsResponse& answer,
                                const v1::RankCandidatesResponse& ranking, OutputFormat format);

}  // namespace tribodyn::client
