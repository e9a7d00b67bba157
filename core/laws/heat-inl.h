// The thermal network of a contact, and its friction.
// Templates on their number type, compiled per instruction set too: see core/laws/laws.h.
#if defined(TRIBODYN_CORE_LAWS_HEAT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_LAWS_HEAT_INL_H_
#undef TRIBODYN_CORE_LAWS_HEAT_INL_H_
#else
#define TRIBODYN_CORE_LAWS_HEAT_INL_H_
#endif

#include <hwy/highway.h>

#include "core/numerics/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

/// U_i/l_i [1/s], the speed of a surface over Coleman's active length, which is the semi-length of
/// the ellipse along the velocity: (u, v) [m/s] and the inverse of the semi-axes along x and y
/// [1/m].
template <class Real>
HWY_INLINE Real speed_per_length(Real velocity_x, Real velocity_y, Real per_semi_x,
                                 Real per_semi_y) {
  return root(square(velocity_x * per_semi_x) + square(velocity_y * per_semi_y));  // (eq 36)
}

/// sqrt(k_s rho_s c_s)/1.06, what a moving heat source meets. The 1.06 is 4 sqrt2/(3 sqrt pi) on
/// the semi-length (Carslaw and Jaeger, band source).
template <class Solid>
HWY_INLINE auto conductance_factor(const Solid& solid) {
  return root(solid.thermal_conductivity * solid.density * solid.specific_heat_capacity) / 1.06;
}

/// 1/R_f,i [W/K] of a surface: A k_s/1.06 sqrt(U_i/(chi l_i)); 0 at rest. With R_cf = h/(2 k_f A),
/// the thermal network.
template <class Parameter, class Real>
HWY_INLINE Real moving_source_conductance(Parameter factor, Real area, Real rate) {
  return factor * area * root(rate);  // (eq 35)
}

/// R_f1 a_h [K/W], flash temperature per watt, from 2 k_f A [W m/K], h [m] and both conductances
/// [W/K]; a_h is this times 1/R_f1. Finite unless both surfaces are at rest.
template <class Real>
HWY_INLINE Real flash_resistance(Real twice_film_conduction, Real film, Real conductance_1,
                                 Real conductance_2) {
  const Real both = film * conductance_2;
  return (twice_film_conduction + both) /
         fused(both + both, conductance_1,
               twice_film_conduction * (conductance_1 + conductance_2));  // (eq 37)
}

/// (dT_oil)_av over tau_bar [K/Pa] in the mid-plane. (dT_f)_av is flash_resistance times the heat.
template <class Parameter, class Real>
HWY_INLINE Real oil_rise_per_stress(Real sliding_speed, Real film, Parameter conductivity) {
  return sliding_speed * film * (1 / (8 * conductivity));  // (eq 39)
}

/// T_c = base + gain tau_bar [K, K/Pa].
template <class Real>
struct ThermalLine {
  Real base, gain;
};
/// With flash_resistance times the sliding speed. Asperities heat the base.
template <class Parameter, class Real>
HWY_INLINE ThermalLine<Real> contact_temperature(Parameter inlet_temperature, Real flash_slide,
                                                 Real boundary_friction, Real viscous_area,
                                                 Real oil_rise_per_stress) {
  return {inlet_temperature + flash_slide * boundary_friction,
          fused(flash_slide, viscous_area, oil_rise_per_stress)};  // (eq 38)
}

/// A_EHL - A_asp [m2], the area that shears lubricant; not below 0, which eq 42 does not rule out.
template <class Real>
HWY_INLINE Real viscous_area(Real contact_area, Real asperity_area) {
  return greatest(contact_area - asperity_area, 0);
}

/// F_v [N].
template <class Real>
HWY_INLINE Real viscous_friction(Real viscous_area, Real mean_shear_stress) {
  return viscous_area * mean_shear_stress;  // (eq 27)
}

/// F_fr [N].
template <class Real>
HWY_INLINE Real friction(Real viscous, Real boundary) {
  return viscous + boundary;  // (eq 28)
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_LAWS_HEAT_INL_H_
