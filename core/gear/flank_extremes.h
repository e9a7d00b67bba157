#pragma once

#include "core/gear/gear_set.h"

namespace tribodyn {

/// What the flanks of a gear set reach where they carry load.
struct FlankExtremes {
  double radius_ratio = 1;  ///< largest ratio of the principal radii of a contact [-]
  /// Squares of the entrainment and sliding speeds where shear heats the inlet most, over the
  /// square of the pinion's speed [m2].
  double entrainment_squared = 0, sliding_squared = 0;
};

FlankExtremes flank_extremes(const GearSet& gear_set);

}  // namespace tribodyn
