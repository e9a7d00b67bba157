#pragma once

namespace tribodyn {

/// State of the 4-DoF system at mesh phase 0 (phi_p a whole number of pitches). The system does not
/// depend on absolute angles, so seven numbers are enough. SI units.
struct SectionState {
  double pinion_shaft_twist = 0;  ///< phi_s - phi_p [rad]
  double gear_shaft_twist = 0;    ///< phi_g - phi_w [rad]
  double pinion_shaft_speed = 0;  ///< phidot_s [rad/s]
  double pinion_speed = 0;        ///< phidot_p [rad/s]
  double gear_speed = 0;          ///< phidot_g [rad/s]
  double wheel_speed = 0;         ///< phidot_w [rad/s]
  double mesh_deflection = 0;     ///< y = x + e, eq 6 in closed form [m]
};

}  // namespace tribodyn
