#pragma once

#include "client/cpp/paper/study.h"

namespace tribodyn::client {

/// The interferometer of figure 9, for fluids 1 to 3.
PaperRig film_rig(int fluid);
/// The traction machine of figure 14, for fluids 1 to 3.
PaperRig traction_rig(int fluid);
inline constexpr double kTractionLoad = 35.2;  ///< [N]; 1 GPa

}  // namespace tribodyn::client
