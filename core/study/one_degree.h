#pragma once

#include "core/study/orbit_refinement.h"

namespace tribodyn {

/// How far the figures of a response under constant torques (Driveline::kConstantTorques) are from
/// those of the full model, relative, as PointResult::estimated_relative_error means it. Shafts,
/// pinion-shaft rotor and wheel are added to first order (shaft_correction), load and power of the
/// flanks are moved with it at the friction coefficients found, and the figures compared; a margin
/// comes on top. No contact is solved: it takes a sixth of the time that the response took.
/// Infinite where that cannot tell: flanks part or may, the correction is not small, or the period
/// is near to doubling.
double one_degree_model_error(GearPairSystem& system, MeshGrids& grids, const OrbitSearch& search,
                              const RefinedOrbit& found);

}  // namespace tribodyn
