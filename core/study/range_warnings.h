#pragma once

#include <vector>

#include "core/study/point_result.h"

namespace tribodyn {

/// Where inputs or results leave the range in which the laws were measured or checked.
std::vector<RangeWarning> range_warnings(const Scene& scene, const PointResult& result);

}  // namespace tribodyn
