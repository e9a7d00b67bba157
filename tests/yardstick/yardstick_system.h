// The 4-degree-of-freedom torsional model of a hypoid gear pair (eqs 1-11 of Paouris et al.) with
// flank friction, in time. Written independently of the product; SI units, radians, kelvin.
#pragma once

#include <array>

#include "yardstick_friction.h"

namespace tribodyn::yardstick {

inline constexpr int kHarmonics = 8;
inline constexpr int kSlots = 3;       ///< flank pairs that may touch at once
inline constexpr int kIntervals = 96;  ///< table intervals per mesh cycle

/// c0 + sum_i s_i sin(i angle) + c_i cos(i angle), i = 1..8; angle = teeth * rotation (eqs 8-11).
struct FourierSeries {
  double constant = 0.0;
  std::array<double, kHarmonics> sine{};
  std::array<double, kHarmonics> cosine{};

  double value(double angle) const;
  double derivative(double angle) const;  ///< per radian of `angle`
  /// Antiderivative without the constant's part: sum_i (-s_i cos + c_i sin)(i angle) / i.
  double oscillating_integral(double angle) const;
};

/// One column of the tooth contact data: samples at psi = 0, 1/96, ... 1 in each slot. Linear
/// inside a slot, no wrap-around (slot k at psi = 1 continues as slot k + 1 at psi = 0).
using SlotTable = std::array<std::array<double, kIntervals + 1>, kSlots>;

struct GearPairParameters {
  int pinion_teeth = 0;
  int gear_teeth = 0;
  double pinion_shaft_inertia = 0.0;        ///< I_s, kg m2
  double pinion_inertia = 0.0;              ///< I_p, kg m2
  double gear_inertia = 0.0;                ///< I_g, kg m2
  double gear_shaft_inertia = 0.0;          ///< I_w, kg m2
  double pinion_shaft_stiffness = 0.0;      ///< k_t1, N m/rad
  double gear_shaft_stiffness = 0.0;        ///< k_t2, N m/rad
  double pinion_shaft_damping = 0.0;        ///< c_t1, N m s/rad
  double gear_shaft_damping = 0.0;          ///< c_t2, N m s/rad
  double mesh_damping = 0.0;                ///< c, N s/m
  double half_backlash = 0.0;               ///< b, m
  FourierSeries pinion_contact_radius;      ///< R_p, m, eq 9
  FourierSeries gear_contact_radius;        ///< R_g, m, eq 8; constant = R_p0 N_g / N_p
  FourierSeries mesh_stiffness;             ///< k_m, N/m, eq 10
  FourierSeries static_transmission_error;  ///< e, m, eq 11
  SlotTable load_share;                     ///< -
  SlotTable radius_x;                       ///< R_zx, m
  SlotTable radius_y;                       ///< R_zy, m
  SlotTable pinion_velocity_x;              ///< u_s,p per rad/s of the pinion, m
  SlotTable pinion_velocity_y;              ///< v_s,p per rad/s of the pinion, m
  SlotTable gear_velocity_x;                ///< u_s,g per rad/s of the gear, m
  SlotTable gear_velocity_y;                ///< v_s,g per rad/s of the gear, m
  SlotTable pinion_friction_arm;            ///< r_fr,p, m; read for kTabulated only
  SlotTable gear_friction_arm;              ///< r_fr,g, m; read for kTabulated only
};

/// Lever arms of eq 29.
enum class FrictionArms {
  /// From the velocity coefficients and the actual sliding direction: the power identity
  /// r_fr,p phi_p' + r_fr,g phi_g' = -V_s is exact. The better model.
  kFromVelocities,
  /// The tabulated arms (those of the kinematic speed ratio): what the worked orbits used. Between
  /// the two choices RMS inefficiency differs by up to 2e-5 (relative), the mean pinion friction
  /// torque by 5e-5 and its extremes by 2e-4.
  kTabulated
};

struct VehicleParameters {
  double mass = 0.0;                ///< m_v, kg
  double rolling_resistance = 0.0;  ///< f_r, -
  double drag_coefficient = 0.0;    ///< c_a, -
  double frontal_area = 0.0;        ///< A_f, m2
  double air_density = 0.0;         ///< rho_air, kg/m3
  double wheel_radius = 0.0;        ///< r_w, m
  double gravity = 9.81;            ///< g, m/s2
  double ascent_angle = 0.0;        ///< a, rad
  double acceleration = 0.0;        ///< du_v/dt, m/s2
};

/// T_w of eq 7 with the inertia of the vehicle, N m.
double resistive_torque(const VehicleParameters& vehicle, double vehicle_speed_meters_per_second);

/// The eight states. Angles are kept as differences so that the transmission error keeps its
/// digits: `mesh_advance` is u = R_p0 phi_p - R_g0 phi_g, of the order of the backlash.
enum StateIndex {
  kPinionShaftTwist,  ///< phi_s - phi_p, rad
  kPinionAngle,       ///< phi_p, rad, 0 at the section
  kMeshAdvance,       ///< R_p0 phi_p - R_g0 phi_g, m
  kGearShaftTwist,    ///< phi_g - phi_w, rad
  kPinionShaftSpeed,  ///< rad/s
  kPinionSpeed,       ///< rad/s
  kGearSpeed,         ///< rad/s
  kGearShaftSpeed,    ///< rad/s
  kStateSize
};
using State = std::array<double, kStateSize>;

/// What the flanks do between two events. "Loaded" means that k_m f + c x' presses the flanks
/// together; while x >= b (or x <= -b) it may turn negative because c x' stays active.
enum class ContactMode {
  kDriveLoaded,    ///< x >= b, k_m f + c x' > 0
  kDriveUnloaded,  ///< x >= b, k_m f + c x' <= 0
  kSeparated,      ///< -b < x < b
  kCoastLoaded,    ///< x <= -b, k_m f + c x' < 0
  kCoastUnloaded   ///< x <= -b, k_m f + c x' >= 0
};

/// Everything known at one instant.
struct Instant {
  State rate{};                          ///< time derivative of the state
  double transmission_error = 0.0;       ///< x, m, eq 6 in closed form
  double transmission_error_rate = 0.0;  ///< x', m/s
  double mesh_force = 0.0;               ///< k_m f + c x', N
  double pinion_friction_torque = 0.0;   ///< T_fr,p of eq 29, N m (negative brakes the pinion)
  double gear_friction_torque = 0.0;     ///< T_fr,g of eq 29, N m
  double friction_power = 0.0;           ///< sum_k V_s F_fr of eq 30, W
  double maximum_temperature = 0.0;      ///< over the loaded flanks, K; -inf if none
  double minimum_film_parameter = 0.0;   ///< over the loaded flanks; +inf if none
  double maximum_pressure = 0.0;         ///< over the loaded flanks, Pa; 0 if none
  double viscous_friction = 0.0;         ///< sum over the flanks, N
  double boundary_friction = 0.0;        ///< sum over the flanks, N
};

/// Immutable after construction.
class GearPairSystem {
 public:
  /// Throws std::invalid_argument unless R_g0 = R_p0 N_g / N_p to 1e-12 relative (x would drift).
  GearPairSystem(const GearPairParameters& gear_pair, const VehicleParameters& vehicle,
                 const ContactFriction& friction,
                 FrictionArms arms = FrictionArms::kFromVelocities);

  /// Right-hand side of eqs 1-4 and all outputs, smooth for a fixed `interval` and `mode`: tables
  /// are extended linearly beyond their interval and f is extended beyond x = +-b.
  Instant evaluate(const State& state, int interval, ContactMode mode, double input_torque,
                   double resistive_torque) const;

  ContactMode mode_of(const State& state) const;

  /// x + e of a state [m].
  double advance_with_error(const State& state) const;
  /// The inverse at the section (phi_p = 0): u [m] with x + e = `target`.
  double mesh_advance_at_section(double target) const;

  double pinion_angle_at_node(int node) const;  ///< phi_p at psi = node / 96, rad

  const GearPairParameters& gear_pair() const { return gear_pair_; }
  const VehicleParameters& vehicle() const { return vehicle_; }
  const ContactFriction& friction() const { return friction_; }

 private:
  double gear_angle(const State& state) const;
  void add_flank_friction(const State& state, int interval, double flank_load,
                          Instant* instant) const;

  GearPairParameters gear_pair_;
  VehicleParameters vehicle_;
  ContactFriction friction_;
  FrictionArms arms_;
};

}  // namespace tribodyn::yardstick
