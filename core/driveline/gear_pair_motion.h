#pragma once

// Bodies of the functions of GearPairSystem that integrators inline.

#include <algorithm>
#include <array>

#include "core/driveline/gear_pair_system.h"
#include "core/driveline/motion-inl.h"

namespace tribodyn {

HWY_INLINE void GearPairSystem::set_kinematics(const MeshPhase& phase, const ContactRegime& regime,
                                               const double* y, Mechanics& out) const {
  // N_g phi_g = N_p phi_p - N_g (mesh approach)/R_g0, because R_g0 N_p = R_p0 N_g.
  out.mesh = mesh_.functions(phase, lag_per_approach_ * y[kMeshApproach]);
  HWY_NAMESPACE::set_mesh_force(constants_, regime.side, y, out);
  if (regime.side != 0) return;
  if (options_.damping_in_contact_only) out.damper_force = 0;
  out.deflection = 0;
  out.mesh_force = out.damper_force;
}

HWY_INLINE void GearPairSystem::set_mechanics(const MeshPhase& phase, const ContactRegime& regime,
                                              const double* y, Mechanics& out) const {
  set_kinematics(phase, regime, y, out);
  const auto shaft = HWY_NAMESPACE::shaft_torques(constants_, y);
  out.pinion_shaft_torque = shaft.pinion;
  out.gear_shaft_torque = shaft.gear;
  out.pinion_friction_torque = out.gear_friction_torque = out.loss_power = 0;
}

HWY_INLINE void GearPairSystem::motion(const MeshPhase& phase, const ContactRegime& regime,
                                       const double* y, const FrictionArms& friction,
                                       const Torques& torques, Mechanics& at, double* dy) const {
  // On local copies: a store through `at` or `dy` could change `*y`, so that the compiler would
  // load it again. A point whose flanks part takes 0.96 of the time (median over three speeds and
  // four tolerances); with this function inlined as well, 0.93.
  std::array<double, kMotionStates> state, rate;
  std::copy_n(y, kMotionStates, state.begin());
  Mechanics here;
  set_mechanics(phase, regime, state.data(), here);
  const double load = regime.load(here.mesh_force);
  here.pinion_friction_torque = friction.pinion * load;
  here.gear_friction_torque = friction.gear * load;
  HWY_NAMESPACE::motion(constants_, options_.energy_consistent, state.data(), here, torques.pinion,
                        torques.wheel, rate.data());
  at = here;
  std::copy_n(rate.begin(), kMotionStates, dy);
}

}  // namespace tribodyn
