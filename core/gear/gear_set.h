#pragma once

#include <array>
#include <vector>

namespace tribodyn {

inline constexpr int kFlankPairs = 3;  ///< pairs that may touch at once (eq 29)

/// mean + sum_i sine[i-1] sin(i theta) + cosine[i-1] cos(i theta), i = 1..harmonics (eqs 8, 9, 10
/// and 11). Both vectors have the same length.
struct FourierSeries {
  double mean = 0;
  std::vector<double> sine;
  std::vector<double> cosine;
};

/// The four series of eqs 8, 9, 10 and 11 at one pinion torque. R_g is in theta_g = N_g phi_g, the
/// others in theta_p = N_p phi_p.
struct MeshSeries {
  FourierSeries pinion_contact_radius;      ///< R_p, eq 9 [m]
  FourierSeries gear_contact_radius;        ///< R_g, eq 8 [m]
  FourierSeries mesh_stiffness;             ///< k_m, eq 10 [N/m]
  FourierSeries static_transmission_error;  ///< e, eq 11 [m]
};

/// One tabulated quantity, [slot][sample]. Slot k holds the pair at roll psi - 1.5 + k pitches;
/// samples are equidistant in mesh phase, the last sample of slot k is the first of slot k + 1.
using SlotTable = std::array<std::vector<double>, kFlankPairs>;

/// Tooth contact data over one mesh cycle. Velocities are coefficients per unit speed of their own
/// member: u_p = A_up phidot_p and so on [m/s per rad/s = m].
struct ToothContactTables {
  SlotTable load_share;         ///< [-], zero where the pair does not touch; slots add up to 1
  SlotTable radius_x;           ///< R_zx [m]
  SlotTable radius_y;           ///< R_zy [m]
  SlotTable pinion_velocity_x;  ///< A_up [m]
  SlotTable pinion_velocity_y;  ///< A_vp [m]
  SlotTable gear_velocity_x;    ///< A_ug [m]
  SlotTable gear_velocity_y;    ///< A_vg [m]
  SlotTable
      contact_point_velocity_x;  ///< per pinion speed [m]; used by subtract_contact_point_motion
  SlotTable contact_point_velocity_y;
  SlotTable
      pinion_friction_arm;  ///< r_fr,p at the mean speed ratio [m]; used by tabulated_friction_arms
  SlotTable gear_friction_arm;  ///< r_fr,g
};

/// Inertias, shafts and mesh of eqs 1, 2, 3, 4 and 5. SI units.
struct DrivelineDynamics {
  double pinion_shaft_inertia;    ///< I_s [kg m2]
  double pinion_inertia;          ///< I_p
  double gear_inertia;            ///< I_g
  double wheel_inertia;           ///< I_w
  double pinion_shaft_stiffness;  ///< k_t1 [N m/rad]
  double gear_shaft_stiffness;    ///< k_t2
  double pinion_shaft_damping;    ///< c_t1 [N m s/rad]
  double gear_shaft_damping;      ///< c_t2
  double mesh_damping;            ///< c [N s/m]
  double half_backlash;           ///< b [m]
};

/// A hypoid gear pair in its driveline: data of the equations of motion (eqs 1, 2, 3, 4, 5 and 6),
/// of the mesh functions (eqs 8, 9, 10 and 11) and of the friction kernel.
struct GearSet {
  int pinion_teeth = 0;  ///< N_p
  int gear_teeth = 0;    ///< N_g
  MeshSeries series;     ///< at the reference torque; used at every torque by default
  ToothContactTables tables;
  DrivelineDynamics dynamics;

  struct SeriesAtTorque {
    double pinion_torque;  ///< [N m]
    MeshSeries series;
  };
  struct LoadShareAtTorque {
    double pinion_torque;  ///< [N m]
    SlotTable load_share;
  };
  /// For ModelOptions::load_dependent_mesh_data; ascending torque, may be empty.
  std::vector<SeriesAtTorque> series_by_torque;
  std::vector<LoadShareAtTorque> load_share_by_torque;
};

/// The gear set with series and load shares interpolated linearly in |pinion_torque| between the
/// tabulated torques (held constant outside them). R_g's mean is set to R_p0 N_g/N_p exactly.
/// Throws Refusal when the set holds no data by torque.
GearSet at_torque(const GearSet& gear_set, double pinion_torque);

/// Throws Refusal, all violations in one sentence, when tables are ragged, values not finite, radii
/// or stiffness not positive over the cycle, a load share negative, shares not summing to 1 within
/// 1e-3, slots not continuous, or R_g0 differs from R_p0 N_g/N_p by more than 1e-9 of itself.
void check(const GearSet& gear_set);

}  // namespace tribodyn
