#pragma once

#include <optional>

#include "core/study/operating_target.h"

namespace tribodyn {

/// Mesh deflection beyond the static one that leads to the vibro-impact response [m].
inline constexpr double kLargeVibrationDeflection = 60e-6;

/// The quasi-static response at mesh phase 0 for PointStart::kQuasiStatic, whose torques leave
/// little for the march to settle; with kLargeVibrationDeflection more for kLargeVibration. Throws
/// the refusal of a contact.
SectionPoint point_start(const PointProblem& problem, PointStart start);

/// The neighbour's steady state, its wind-up and speeds moved to this point.
MarchState carried_start(const GearPairSystem& system, const CarriedState& from,
                         const OperatingTarget& target);

}  // namespace tribodyn
