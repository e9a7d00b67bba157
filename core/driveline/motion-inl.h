// The equations of motion of the driveline and their linear form. Templates on their number type,
// compiled per instruction set too: see core/laws/laws.h. y: time and the seven states, in the
// order of MarchComponent.
#if defined(TRIBODYN_CORE_DRIVELINE_MOTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_DRIVELINE_MOTION_INL_H_
#undef TRIBODYN_CORE_DRIVELINE_MOTION_INL_H_
#else
#define TRIBODYN_CORE_DRIVELINE_MOTION_INL_H_
#endif

#include <hwy/highway.h>

#include "core/driveline/motion.h"
#include "core/numerics/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

/// Sets transmission error, deflection and mesh force of flanks that touch on `side` (+1 drive, -1
/// coast), from the mesh functions in `at`.
template <class Real>
HWY_INLINE void set_mesh_force(const MotionConstants& c, double side, const Real* y,
                               MechanicsOf<Real>& at) {
  const MeshFunctionsOf<Real>& m = at.mesh;
  // x - b, because on the drive side the deflection then keeps all its digits.
  const Real beyond = y[kMeshApproach] + m.radius_integral - m.static_transmission_error;
  at.transmission_error = beyond + c.half_backlash;       // (eq 6)
  at.deflection = beyond + (1 - side) * c.half_backlash;  // (eq 5)
  at.transmission_velocity =
      less_product(m.gear_contact_radius, y[kGearSpeed],
                   (m.pinion_contact_radius - m.static_transmission_error_slope) * y[kPinionSpeed]);
  at.damper_force = c.mesh_damping * at.transmission_velocity;
  at.mesh_force = fused(m.mesh_stiffness, at.deflection, at.damper_force);
}

/// What eq 2 leaves out: F e' - k_m' f^2/2 [N m].
template <class Real>
HWY_INLINE Real parametric_torque(const MechanicsOf<Real>& at) {
  return at.mesh_force * at.mesh.static_transmission_error_slope -
         0.5 * at.mesh.mesh_stiffness_slope * at.deflection * at.deflection;
}

/// Torques of the shafts [N m].
template <class Real>
struct ShaftTorques {
  Real pinion, gear;
};
template <class Real>
HWY_INLINE ShaftTorques<Real> shaft_torques(const MotionConstants& c, const Real* y) {
  return {fused(c.pinion_shaft_stiffness, y[kPinionShaftTwist],
                c.pinion_shaft_damping * (y[kPinionShaftSpeed] - y[kPinionSpeed])),
          fused(c.gear_shaft_stiffness, y[kGearShaftTwist],
                c.gear_shaft_damping * (y[kGearSpeed] - y[kWheelSpeed]))};
}

/// d state / d phase, from the torques at the instant. With `energy_consistent` the torques that
/// eq 2 leaves out are added to it.
template <class Real>
HWY_INLINE void motion(const MotionConstants& c, bool energy_consistent, const Real* y,
                       const MechanicsOf<Real>& at, double pinion_torque, double wheel_torque,
                       Real* dy) {
  Real pinion = less_product(at.mesh.pinion_contact_radius, at.mesh_force, at.pinion_shaft_torque) +
                at.pinion_friction_torque;
  if (energy_consistent) pinion = pinion + parametric_torque(at);
  const Real gear = fused(at.mesh.gear_contact_radius, at.mesh_force, -at.gear_shaft_torque) +
                    at.gear_friction_torque;
  const Real time = c.cycle_angle / y[kPinionSpeed];
  dy[kTime] = time;
  dy[kPinionShaftTwist] = time * (y[kPinionShaftSpeed] - y[kPinionSpeed]);
  dy[kMeshApproach] =
      time * less_product(c.gear_radius, y[kGearSpeed], c.pinion_radius * y[kPinionSpeed]);
  dy[kGearShaftTwist] = time * (y[kGearSpeed] - y[kWheelSpeed]);
  const Real pinion_shaft = pinion_torque - at.pinion_shaft_torque;
  const Real wheel = at.gear_shaft_torque - wheel_torque;
  dy[kPinionShaftSpeed] = time * (pinion_shaft * c.per_pinion_shaft_inertia);  // (eq 1)
  dy[kPinionSpeed] = time * (pinion * c.per_pinion_inertia);                   // (eq 2)
  dy[kGearSpeed] = time * (gear * c.per_gear_inertia);                         // (eq 3)
  dy[kWheelSpeed] = time * (wheel * c.per_wheel_inertia);                      // (eq 4)
}

/// Where motion() is differentiated: what the slopes need besides mechanics and state.
template <class Real>
struct SlopePlace {
  bool touches;               ///< the mesh spring acts: no gap
  double damping;             ///< of the mesh, in effect [N s/m]
  Real load_by_force;         ///< of the flanks' load by the mesh force: +1, -1, or 0 without load
  Real radius_by_approach;    ///< dR_g/d(mesh approach) [-]
  Real pinion_arm, gear_arm;  ///< of the friction, over the load [m]
};

/// The partial derivatives of motion() at `y`, with the friction arms held. `dy`: of motion().
template <class Real>
HWY_INLINE void set_motion_slopes(const MotionConstants& c, bool energy_consistent,
                                  const SlopePlace<Real>& place, const MechanicsOf<Real>& at,
                                  const Real* y, const Real* dy, MotionSlopesOf<Real>& out) {
  const MeshFunctionsOf<Real>& m = at.mesh;
  const Real error_by_approach = m.gear_contact_radius * (1 / c.gear_radius);
  out.relative_radius = m.pinion_contact_radius - m.static_transmission_error_slope;
  out.gear_radius = m.gear_contact_radius;
  out.damping = place.damping;
  out.force_by_approach =
      less_product(place.damping * place.radius_by_approach, y[kGearSpeed],
                   place.touches ? m.mesh_stiffness * error_by_approach : Real(0));
  out.pinion_arm = fused(place.load_by_force, place.pinion_arm, -m.pinion_contact_radius);
  out.gear_arm = fused(place.load_by_force, place.gear_arm, m.gear_contact_radius);
  out.pinion_torque_by_approach = Real(0);
  out.gear_torque_by_approach = at.mesh_force * place.radius_by_approach;
  if (energy_consistent) {
    out.pinion_arm = out.pinion_arm + m.static_transmission_error_slope;
    if (place.touches) {
      out.pinion_torque_by_approach = -m.mesh_stiffness_slope * at.deflection * error_by_approach;
    }
  }
  out.time = dy[kTime];
  out.per_speed = 1 / y[kPinionSpeed];
  for (int i = 0; i < kMotionStates; ++i) out.rate[i] = dy[i];
}

/// The derivative of motion() by time in the direction `s`, besides torques that change by
/// themselves: callers add those, then call by_phase(). Real: what the directions are; the slopes'
/// numbers are its factors.
template <class Factor, class Real>
HWY_INLINE void linear_motion(const MotionConstants& c, const MotionSlopesOf<Factor>& at,
                              const Real* s, Real* ds) {
  const Real velocity =
      less_product(at.gear_radius, s[kGearSpeed], at.relative_radius * s[kPinionSpeed]);
  const Real force = fused(at.force_by_approach, s[kMeshApproach], at.damping * velocity);
  const ShaftTorques<Real> shaft = shaft_torques(c, s);
  const Real pinion = fused(at.pinion_torque_by_approach, s[kMeshApproach],
                            fused(at.pinion_arm, force, shaft.pinion));
  const Real gear =
      fused(at.gear_torque_by_approach, s[kMeshApproach], fused(at.gear_arm, force, -shaft.gear));
  ds[kTime] = Real(0);
  ds[kPinionShaftTwist] = s[kPinionShaftSpeed] - s[kPinionSpeed];
  ds[kMeshApproach] = less_product(c.gear_radius, s[kGearSpeed], c.pinion_radius * s[kPinionSpeed]);
  ds[kGearShaftTwist] = s[kGearSpeed] - s[kWheelSpeed];
  ds[kPinionShaftSpeed] = -c.per_pinion_shaft_inertia * shaft.pinion;
  ds[kPinionSpeed] = c.per_pinion_inertia * pinion;
  ds[kGearSpeed] = c.per_gear_inertia * gear;
  ds[kWheelSpeed] = c.per_wheel_inertia * shaft.gear;
}

/// Turns a derivative by time into one by phase: the time of a cycle changes with the speed.
template <class Factor, class Real>
HWY_INLINE void by_phase(const MotionSlopesOf<Factor>& at, const Real* s, Real* ds) {
  const Real faster = at.per_speed * s[kPinionSpeed];
  for (int i = 0; i < kMotionStates; ++i) {
    ds[i] = less_product(at.rate[i], faster, at.time * ds[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_DRIVELINE_MOTION_INL_H_
