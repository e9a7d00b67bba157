#pragma once

#include <optional>
#include <vector>

#include "core/periodic/periodic_orbit.h"
#include "core/study/operating_target.h"

namespace tribodyn {

/// BARELY_ATTRACTS, if the modulus of the largest Floquet multiplier is within `doubt` of 1: the
/// response repeats, but whether disturbances die out is not certain. Absent otherwise.
std::optional<RangeWarning> barely_attracts_warning(double multiplier, double doubt);

/// What an orbit says of itself: that it barely attracts, or that flanks tap each other under
/// hardly any load.
std::vector<RangeWarning> orbit_warnings(const PeriodicOrbit& orbit);

/// That another response exists at the same point (periodic/loud_response.h): one with contact loss
/// where `contact_loss` is false, one without where it is true. Absent where none is found, or
/// PointOptions::warn_of_coexisting_response is false.
std::optional<RangeWarning> coexistence_warning(const PointProblem& problem, bool contact_loss);

}  // namespace tribodyn
