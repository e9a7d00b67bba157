#pragma once

#include <optional>

#include "core/periodic/find_orbit.h"
#include "core/study/operating_target.h"

namespace tribodyn {

/// Marches until the response repeats, and records it. With method = AUTOMATIC the march is short
/// where no steady state is to be found: of a motion that rattles, or of gears that no torque holds
/// together; the result then has a warning that says so. Throws Refusal TOO_SLOW_TO_MARCH if the
/// march would have to follow the mesh through too many oscillations, and as the march does.
PointResult solve_by_marching(const PointProblem& problem, PointStart start,
                              const std::optional<CarriedState>& from,
                              const HistoryRequest& history,
                              const std::optional<SectionPoint>& aperiodic);

}  // namespace tribodyn
