#pragma once

#include <string>

#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {

/// Returns the picture (SVG) of the shares of groups of parameters in the difference of two
/// lubricants: bars of the weighted mean with 95 % intervals, and below them, for several
/// conditions, the shares stacked for each condition. Requires a mean that the model does not
/// refuse.
std::string explanation_plot(const v1::ExplainPointsRequest& request,
                             const v1::ExplainPointsResponse& response);

}  // namespace tribodyn::client
