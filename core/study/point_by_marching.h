#pragma once

#include <optional>

#include "core/periodic/find_orbit.h"
#include "core/study/operating_target.h"

namespace tribodyn {

/// The limit of a march's work with method = AUTOMATIC, in contact solutions: search, multipliers
/// and average together. Some 0.4 s.
inline constexpr double kMostContactsOfAutomaticMarch = 2.2e5;
/// With method = MARCH the limit is so many contact solutions for each mesh cycle of
/// PointOptions::maximum_mesh_cycles: from 2 km/h on twice of what the reference axle takes for a
/// mesh cycle, 2,000 to 4,000. So the default of 4,000 mesh cycles ends after some 40 s.
inline constexpr double kMostContactsPerMeshCycle = 8000;

/// The limit of a march's work by the options, in contact solutions.
double most_contacts_of_march(const PointOptions& options);
/// Of the steps, and of the response as it settles: what the options state, or less where their
/// tolerance asks for it.
double march_step_tolerance(const PointOptions& options);
double march_settling_tolerance(const PointOptions& options);

/// Marches until the response repeats, and records its period; or else records the response until
/// the error of its average is within the tolerance (rattle_average.h). A period is searched for in
/// the first part of the limits of work, and with method = AUTOMATIC not at all where none is to be
/// expected: of a motion that rattles, or of gears that no torque holds together; the result then
/// has a warning that says so. The record of a period and the history come on top of the limits.
/// Throws Refusal TOO_SLOW_TO_MARCH if the limit of contact solutions ends the march before there
/// is anything to average, and as the march does.
PointResult solve_by_marching(const PointProblem& problem, PointStart start,
                              const std::optional<CarriedState>& from,
                              const HistoryRequest& history,
                              const std::optional<SectionPoint>& aperiodic);

}  // namespace tribodyn
