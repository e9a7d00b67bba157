#pragma once

#include <string>

#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {

/// Returns the picture (SVG) of a comparison over speed: the inefficiency of each lubricant and, of
/// several, its difference from the first, with their 95 % intervals as bands. Markers are hollow
/// where the verdict is CANNOT_BE_TOLD_APART.
std::string comparison_plot(const v1::ComparePointsRequest& request,
                            const v1::ComparePointsResponse& response);

}  // namespace tribodyn::client
