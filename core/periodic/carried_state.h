#pragma once

#include "core/driveline/section_state.h"

namespace tribodyn {

/// A neighbour's steady state, to start from. Speeds and wind-up are shifted to the new point.
struct CarriedState {
  SectionState section_state;
  double mean_pinion_speed = 0;  ///< [rad/s]
  double pinion_torque = 0;      ///< T_s there [N m]
  double wheel_torque = 0;       ///< T_w there [N m]
  int period = 1;                ///< of the response there [mesh cycles]; 0: none found
  bool contact_loss = false;     ///< there
};

}  // namespace tribodyn
