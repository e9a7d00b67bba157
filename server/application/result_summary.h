#pragma once

#include <cstddef>

#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

inline constexpr std::size_t kMaximumSummaryBytes = 65'536;

/// Leaves a result that is no larger than that as it is. Of a larger one every point keeps a
/// summary in place of its result, so that no figure that is left out reads as zero.
void abridge(v1::SimulationResult& result);

}  // namespace tribodyn::server
