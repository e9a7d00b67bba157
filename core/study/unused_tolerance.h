#pragma once

#include <optional>

#include "core/study/point_result.h"

namespace tribodyn {

/// MARCH_TOLERANCE_UNUSED, if march_step_tolerance or march_settling_tolerance differs from its
/// default and nothing read it: only a march does. Returns nullopt otherwise.
std::optional<RangeWarning> unused_march_tolerance(const PointOptions& options,
                                                   const PointResult& result);

}  // namespace tribodyn
