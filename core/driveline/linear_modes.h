#pragma once

#include <array>

#include "core/driveline/gear_pair_system.h"

namespace tribodyn {

/// A mode of vibration of the driveline.
struct LinearMode {
  double frequency = 0;  ///< undamped [rad/s]
  double damping = 0;    ///< of the critical one; 1 or more: no vibration [-]
};

/// The modes of eqs 1, 2, 3 and 4 with flanks that never part, mean contact radii and mean mesh
/// stiffness, and without friction; in ascending frequency. The rigid rotation is left out.
std::array<LinearMode, 3> linear_modes(const GearPairSystem& system);

}  // namespace tribodyn
