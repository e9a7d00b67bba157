#pragma once

namespace tribodyn {

/// Road load of eq 7. SI units.
struct Vehicle {
  double mass;                            ///< m_v [kg]
  double rolling_resistance_coefficient;  ///< f_r [-]
  double drag_coefficient;                ///< c_a [-]
  double frontal_area;                    ///< A_f [m2]
  double air_density;                     ///< rho_air [kg/m3]
  double wheel_radius;                    ///< r_w [m]
  double gravity;                         ///< g [m/s2]
};

/// Throws Refusal PARAMETER_OUT_OF_RANGE, all violations in one sentence, if a value is not finite
/// or of a sign that no vehicle has.
void check(const Vehicle& vehicle);

/// T_w of eq 7 plus the vehicle's inertia [N m] at the ring gear shaft:
///
///   T_w = r_w (m_v g f_r cos(a) + m_v g sin(a) + c_a A_f rho_air/2 u_v^2 + m_v du_v/dt).
///
/// speed u_v [m/s], ascent_angle a [rad], acceleration du_v/dt [m/s2]. Negative where the vehicle
/// drives the axle (downhill, braking). For forward motion: rolling resistance and drag keep their
/// sign. Throws Refusal SPEED_NOT_FORWARD for a speed that is negative or not finite, and as
/// check(Vehicle) does.
/// Source: Bosch, Automotive Handbook (2004).
double wheel_torque(const Vehicle& vehicle, double speed, double ascent_angle, double acceleration);

}  // namespace tribodyn
