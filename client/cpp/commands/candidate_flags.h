#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/flags.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::client {

/// Adds --uncertainty, which states standard uncertainties of parameters.
void add_uncertainty_flag(FlagList& list, std::vector<v1::ParameterUncertainty>& out);

/// Reads "COLUMN", "COLUMN:min", "COLUMN:max" or "COLUMN:mean" into `out`, each also after the name
/// of a campaign: "12/COLUMN". Adds a complaint about `flag` if the text is none of them.
void read_candidate_figure(const std::string& flag, const std::string& text,
                           v1::CandidateFigure& out, Complaints& complaints);

/// Reads a figure and a limit, e.g. "film_ratio_minimum:min>=0.8" or "cost<=3".
void read_candidate_constraint(const std::string& flag, const std::string& text,
                               std::vector<v1::CandidateConstraint>& out, Complaints& complaints);

}  // namespace tribodyn::client
