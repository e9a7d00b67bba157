#pragma once

#include <optional>

#include "core/study/operating_target.h"

namespace tribodyn {

/// Mesh deflection beyond the static one that leads to the vibro-impact response [m].
inline constexpr double kLargeVibrationDeflection = 60e-6;

/// The response with contact loss that PointStart::kLargeVibration starts from, if there is one.
std::optional<CarriedState> loud_response(const PointProblem& problem);

/// The quasi-static response at mesh phase 0 for PointStart::kQuasiStatic, whose torques leave
/// little for the march to settle; for kLargeVibration loud_response(), or the static response with
/// kLargeVibrationDeflection more. Throws the refusal of a contact.
SectionPoint point_start(const PointProblem& problem, PointStart start);

/// The neighbour's steady state, its wind-up and speeds moved to this point.
MarchState carried_start(const GearPairSystem& system, const CarriedState& from,
                         const OperatingTarget& target);

}  // namespace tribodyn
