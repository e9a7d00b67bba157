// The place where the stress leaves its limit behind the rim of a contact.
// Compiled once per instruction set by contact_block.cpp and contact_slopes.cpp.
#if defined(TRIBODYN_CORE_CONTACT_LIMITED_RIM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_CONTACT_LIMITED_RIM_INL_H_
#undef TRIBODYN_CORE_CONTACT_LIMITED_RIM_INL_H_
#else
#define TRIBODYN_CORE_CONTACT_LIMITED_RIM_INL_H_
#endif

#include <hwy/highway.h>

#include "core/numerics/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

/// h = tau - tau_L at x = c p. tau_L is a line over x, so that h is convex where tau is
/// (ContactBlockTables::convex_factor). If h > 0 at the edge, as always with tau_L0 = 0, it is
/// positive everywhere, or negative from its first root on: up to the centre or to a second root.
struct LimitExcess {
  Pack value, slope;
  Pack curvature;  ///< tau (d ln tau/dx)^2: the second derivative but for that of ln tau

  /// `steepness`: d ln tau/dx; `limit`: tau_L there; `limit_slope`: d tau_L/dx.
  HWY_INLINE LimitExcess(Pack stress, Pack steepness, Pack limit, double limit_slope)
      : value(stress - limit),
        slope(stress * steepness - limit_slope),
        curvature(stress * steepness * steepness) {}
};

/// The way to the first root of h, by the parabola of the same value, slope and curvature; to the
/// parabola's vertex if it has no root.
struct RimStep {
  Pack change;  ///< of x
  Pack fall;    ///< -dh/dx at the parabola's root; 0 if it has none
  Mask meets;   ///< it has one

  HWY_INLINE explicit RimStep(const LimitExcess& h) {
    const Pack discriminant = less_product(2 * h.value, h.curvature, h.slope * h.slope);
    meets = discriminant >= 0;
    fall = root(greatest(discriminant, 0));
    const Mask falls = h.slope < 0;
    const Pack over = select(falls & meets, 2 * h.value, -(h.slope + fall));
    change = over / select(falls & meets, fall - h.slope, h.curvature);
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_CONTACT_LIMITED_RIM_INL_H_
