#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/warnings.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {

/// Returns the words for a group of parameters, e.g. "shear thinning".
std::string parameter_group_text(v1::ParameterGroup group);

/// Returns the causes of the mean difference, that with the largest share of inefficiency first.
std::vector<v1::DifferenceCause> ranked_causes(const v1::DifferenceExplanation& explanation);

/// Returns the warnings of all points with the speeds that have them.
std::vector<ShownWarning> explanation_warnings(const v1::ExplainPointsRequest& request,
                                               const v1::ExplainPointsResponse& response);

/// Returns the shares of groups of parameters in the difference of two lubricants: of the weighted
/// mean with uncertainties and interactions, then at each condition.
std::string explanation_report(const v1::ExplainPointsRequest& request,
                               const v1::ExplainPointsResponse& response);

/// Returns a row for each group at each condition, and last for each group in the mean, with all
/// digits.
std::string explanation_csv(const v1::ExplainPointsRequest& request,
                            const v1::ExplainPointsResponse& response);

}  // namespace tribodyn::client
