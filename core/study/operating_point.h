#pragma once

#include <memory>

#include "core/study/point_options.h"
#include "core/study/point_result.h"
#include "core/study/prepared_scene.h"

namespace tribodyn {

/// Solves one operating point. Throws Refusal (reasons: contact_status_name, NO_FORWARD_ROTATION,
/// WORK_LIMIT, ...) or Cancelled.
/// `gear_set`: that of the scene where it is prepared already, as PreparedScene takes it; null: it
/// is prepared here. The result is the same bits either way.
PointResult solve_operating_point(const Scene& scene, const OperatingCondition& condition,
                                  const PointOptions& options,
                                  std::shared_ptr<PreparedGearSet> gear_set = nullptr);
/// The same bits, for many points of one scene.
PointResult solve_prepared_point(PreparedScene& scene, const OperatingCondition& condition,
                                 const PointOptions& options);

}  // namespace tribodyn
