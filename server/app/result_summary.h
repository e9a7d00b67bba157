#pragma once

#include <cstddef>

#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

inline constexpr std::size_t kMaximumSummaryBytes = 65'536;

/// Leaves a result that is no larger than that as it is; of a larger one the main figures of every
/// point.
void abridge(v1::SimulationResult& result);

}  // namespace tribodyn::server
