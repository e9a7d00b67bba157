// Motion of a flank pair. Templates on their number type, compiled per instruction set too: see
// core/laws/laws.h.
#if defined(TRIBODYN_CORE_GEAR_FLANK_MOTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_GEAR_FLANK_MOTION_INL_H_
#undef TRIBODYN_CORE_GEAR_FLANK_MOTION_INL_H_
#else
#define TRIBODYN_CORE_GEAR_FLANK_MOTION_INL_H_
#endif

#include <hwy/highway.h>

#include "core/gear/mesh_data.h"
#include "core/numerics/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

/// Sets velocities and lever arms r_p = -(dV . A_p)/V_s, r_g = (dV . A_g)/V_s with dV the sliding
/// vector: the power identity is exact and holds when a shaft turns backwards. Without sliding both
/// arms are 0. With `tabulated_arms` the arms are those of the tables. Number: of the tables,
/// double or a pack; Real: of the speeds, the same or a dual number.
template <class Number, class Real>
HWY_INLINE void set_flank_motion(const FlankKinematicsOf<Number>& k, const Real& pinion_speed,
                                 const Real& gear_speed, bool tabulated_arms,
                                 FlankMotionOf<Real>& out) {
  out.pinion_x = k.pinion_velocity_x * pinion_speed;
  out.pinion_y = k.pinion_velocity_y * pinion_speed;
  out.gear_x = k.gear_velocity_x * gear_speed;
  out.gear_y = k.gear_velocity_y * gear_speed;
  const Real slide_x = out.pinion_x - out.gear_x, slide_y = out.pinion_y - out.gear_y;
  out.sliding_speed = root(fused(slide_x, slide_x, square(slide_y)));
  if (tabulated_arms) {
    out.pinion_friction_arm = k.pinion_friction_arm;
    out.gear_friction_arm = k.gear_friction_arm;
    return;
  }
  const Real per_speed = select(out.sliding_speed > 0, 1 / out.sliding_speed, Real(0));
  out.pinion_friction_arm =
      -per_speed * fused(slide_x, k.pinion_velocity_x, slide_y * k.pinion_velocity_y);
  out.gear_friction_arm =
      per_speed * fused(slide_x, k.gear_velocity_x, slide_y * k.gear_velocity_y);
}

/// Subtracts the motion of the contact point along the flanks from the surface velocities.
template <class Number, class Real>
HWY_INLINE void subtract_drift(const FlankKinematicsOf<Number>& k, const Real& pinion_speed,
                               FlankMotionOf<Real>& motion) {
  const Real x = k.contact_point_velocity_x * pinion_speed;
  const Real y = k.contact_point_velocity_y * pinion_speed;
  motion.pinion_x = motion.pinion_x - x;
  motion.pinion_y = motion.pinion_y - y;
  motion.gear_x = motion.gear_x - x;
  motion.gear_y = motion.gear_y - y;
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_GEAR_FLANK_MOTION_INL_H_
