#pragma once

#include <string>

#include "tribodyn/v1/results.pb.h"

namespace tribodyn::client {

/// Returns a table of the figures of a point or curve beside their limits; of a curve the figure
/// that is farthest, and at how many speeds the limit is not kept. An empty text if the result has
/// no limits, or none of its points has a figure.
std::string limits_report(const v1::SimulationResult& result);

}  // namespace tribodyn::client
