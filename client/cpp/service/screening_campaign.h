#pragma once

#include <functional>
#include <string>
#include <vector>

#include "client/cpp/report/screening.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// Ranks the candidates of a campaign by their figures alone, which solves no points: what the
/// service says of up to 10,000 of them, such as their warnings and refusals.
v1::RankCandidatesResponse figures_ranking(Connection& connection,
                                           v1::RankCandidatesRequest request);

/// Returns the indices of the candidates without a refusal: those of the campaign, in its order.
std::vector<std::size_t> accepted_candidates(const CandidateTable& table);

/// Returns the campaign with the conditions and the base of a screening, without candidates.
v1::Campaign campaign_without_candidates(const Screening& screening, const std::string& title);

/// Returns the campaign that computes the candidates without a refusal, in their order. It keeps
/// the candidates' names, carried columns and uncertainties as attributes.
v1::Campaign campaign_of(const Screening& screening, const std::string& title);

/// Returns a header as the name of an attribute: "treat rate" becomes "treat_rate".
std::string attribute_text(const std::string& header);

/// Returns the request that adds the candidates of a screening to a campaign. A parameter of the
/// campaign that they do not state is as in the base; names go along if the campaign has names.
v1::AppendCandidatesRequest further_candidates(const Screening& screening,
                                               const v1::Campaign& campaign);

/// Returns the id under which a campaign is created, e.g. "screen-3f1c...": a hash of all that
/// decides its figures, so that the same screening finds the campaign that it made.
std::string screening_request_id(v1::Campaign campaign, const std::string& model_version);

/// Creates a campaign under that id; or finds the one with the same figures, and gives it the
/// title, labels and weights of this one, and the attributes unless candidates were added to it
/// since.
v1::Campaign create_or_find(Connection& connection, v1::Campaign campaign,
                            const std::string& model_version);

/// Returns the screening of a campaign, without points: the opposite of campaign_of(). Candidates
/// without names have their numbers, counted from 1. Evaluates the base.
Screening screening_of(Connection& connection, const v1::Campaign& campaign);

/// Reads the points of the campaign, finished or not.
void read_points(Connection& connection, const v1::Campaign& campaign, Screening& screening);

}  // namespace tribodyn::client
