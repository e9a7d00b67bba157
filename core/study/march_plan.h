#pragma once

#include <optional>

#include "core/study/operating_target.h"
#include "core/study/orbit_refinement.h"

namespace tribodyn {

/// Mesh deflection beyond the static one that leads to the vibro-impact response [m].
inline constexpr double kLargeVibrationDeflection = 60e-6;

/// How a point is marched.
struct MarchPlan {
  MarchState start{};  ///< at mesh phase 0
  int first_period = 1;
  int maximum_mesh_cycles = 0;               ///< of the search for the steady state
  std::optional<RangeWarning> why_so_short;  ///< why that is less than the options say
};

/// Of the march's steps; no looser than the figures' tolerance allows.
double march_tolerance(const PointOptions& options);

/// A single point's start: the quasi-static response at mesh phase 0, whose torques leave little
/// for the march to settle, or that with kLargeVibrationDeflection more.
MarchState point_start(GearPairSystem& system, const FlankContactBatch& contacts, MeshGrids& grids,
                       const OperatingTarget& target, const PointOptions& options,
                       PointStart start);

/// The neighbour's steady state, its wind-up and speeds moved to this point.
MarchState carried_start(const GearPairSystem& system, const CarriedState& from,
                         double mean_pinion_speed);

/// For a point that shooting does not find; also sets the torques that the march starts with.
/// With method = AUTOMATIC nothing is searched for that is known not to be there: no steady state
/// of a motion that rattles, or of gears that no torque holds together. Throws Refusal
/// TOO_SLOW_TO_MARCH if the march would have to follow the mesh through too many oscillations.
MarchPlan plan_march(GearPairSystem& system, const FlankContactBatch& contacts, MeshGrids& grids,
                     const OperatingTarget& target, const PointOptions& options, PointStart start,
                     const std::optional<CarriedState>& from, const std::optional<Rattle>& rattle);

}  // namespace tribodyn
