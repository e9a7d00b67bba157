#pragma once

#include <array>

#include "core/gear/mesh_data.h"

namespace tribodyn {

/// State of the march over mesh phase. The pinion angle is the independent variable, so that the
/// samples of the tooth contact tables and the mesh cycle fall on known places; time is a
/// component. Twists and the mesh approach are differences of angles and stay small.
enum MarchComponent {
  kTime,              ///< [s] since the section
  kPinionShaftTwist,  ///< phi_s - phi_p [rad]
  kMeshApproach,      ///< R_p0 phi_p - R_g0 phi_g [m]
  kGearShaftTwist,    ///< phi_g - phi_w [rad]
  kPinionShaftSpeed,  ///< [rad/s]
  kPinionSpeed,
  kGearSpeed,
  kWheelSpeed,
  kLossWork,  ///< int sum V_s F_fr dt [J]
  /// int (sum V_s F_fr / input_speed())^2 dt [(N m)^2 s]: eq 30's RMS but for the torque
  kLossShareSquared,
  kMarchComponents
};

using MarchState = std::array<double, kMarchComponents>;

/// Time and the seven states of motion.
inline constexpr int kMotionStates = kWheelSpeed + 1;

/// What the equations of motion hold constant. SI units.
struct MotionConstants {
  double pinion_shaft_stiffness, pinion_shaft_damping, gear_shaft_stiffness, gear_shaft_damping;
  double per_pinion_shaft_inertia, per_pinion_inertia, per_gear_inertia, per_wheel_inertia;
  double mesh_damping, half_backlash;
  double pinion_radius, gear_radius;  ///< R_p0, R_g0
  double cycle_angle;                 ///< phi_p per mesh cycle, 2 pi/N_p [rad]
};

/// Forces and torques at one instant. Real: double or a pack.
template <class Real>
struct MechanicsOf {
  MeshFunctionsOf<Real> mesh;
  Real deflection;             ///< f [m]
  Real transmission_error;     ///< x [m]
  Real transmission_velocity;  ///< xdot [m/s]
  Real mesh_force;             ///< k_m f + c xdot [N]; of which the damper:
  Real damper_force;
  Real pinion_shaft_torque;  ///< [N m]
  Real gear_shaft_torque;
  Real pinion_friction_torque;
  Real gear_friction_torque;
  Real loss_power;  ///< sum V_s F_fr [W]
};
using Mechanics = MechanicsOf<double>;

/// Adds the friction [N] of a flank pair to the friction torques and the loss power of `sums`: its
/// lever arms [m] and sliding speed [m/s] as in FlankMotion.
template <class Sums>
inline void add_flank_friction(double pinion_arm, double gear_arm, double sliding_speed,
                               double friction, Sums& sums) {
  sums.pinion_friction_torque += pinion_arm * friction;  // (eq 29)
  sums.gear_friction_torque += gear_arm * friction;
  sums.loss_power += sliding_speed * friction;
}

/// Partial derivatives of the equations of motion at one instant, by the states and by the friction
/// arms. Real: double or a pack.
template <class Real>
struct MotionSlopesOf {
  Real relative_radius, gear_radius;  ///< R_p - e', R_g [m]
  Real force_by_approach;             ///< of the mesh force [N/m]
  Real damping;                       ///< of the mesh force [N s/m]
  Real pinion_arm, gear_arm;          ///< what a mesh force turns, friction included [m]
  Real pinion_torque_by_approach, gear_torque_by_approach;  ///< besides the mesh force's [N]
  Real time, per_speed;                                     ///< of a mesh cycle [s]; 1/speed
  std::array<Real, kMotionStates> rate;                     ///< of time and states by phase
};
using MotionSlopes = MotionSlopesOf<double>;

}  // namespace tribodyn
