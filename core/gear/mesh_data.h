#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/gear/gear_set.h"
#include "core/gear/mesh_expansion.h"

namespace tribodyn {

/// Eqs 8, 9, 10 and 11 at one pair of angles, with what the closed-form transmission error and the
/// energy terms need. Slopes are per radian of phi_p. Real: double or a pack.
template <class Real>
struct MeshFunctionsOf {
  Real pinion_contact_radius;            ///< R_p [m]
  Real gear_contact_radius;              ///< R_g [m]
  Real radius_integral;                  ///< series part of int R_p dphi_p - int R_g dphi_g [m]
  Real mesh_stiffness;                   ///< k_m [N/m]
  Real mesh_stiffness_slope;             ///< dk_m/dphi_p [N/m/rad]
  Real static_transmission_error;        ///< e [m]
  Real static_transmission_error_slope;  ///< de/dphi_p [m/rad]
};
using MeshFunctions = MeshFunctionsOf<double>;

/// The terms of eqs 8, 9, 10 and 11 that the pinion's angle alone decides: prepared once per phase,
/// used at every state.
struct MeshPhase {
  double theta;                              ///< [rad]
  MeshFunctions pinion;                      ///< R_g its mean, radius_integral the pinion's part
  const MeshExpansion* expansion = nullptr;  ///< the nearest one; null: by the series
  double offset = 0;                         ///< of theta from there [rad]
};

/// Amplitudes of one order of eqs 8, 9, 10 and 11.
struct MeshOrder {
  double displacement = 0;  ///< of e, and of the radii's integrals over their angles, added [m]
  double stiffness = 0;     ///< of k_m over its mean [-]
  double radius = 0;        ///< of R_p and R_g over their means, added [-]
};

/// One flank pair at one mesh phase; columns of ToothContactTables. Real: double or a pack.
template <class Real>
struct FlankKinematicsOf {
  Real load_share;
  Real radius_x, radius_y;
  Real pinion_velocity_x, pinion_velocity_y;
  Real gear_velocity_x, gear_velocity_y;
  Real contact_point_velocity_x, contact_point_velocity_y;
  Real pinion_friction_arm, gear_friction_arm;
};
using FlankKinematics = FlankKinematicsOf<double>;

/// Where a column of the tables is in FlankKinematics, and what refusals call it.
struct FlankColumn {
  SlotTable ToothContactTables::*table;
  double FlankKinematics::*value;
  const char* name;
  bool positive = false;
};

/// All columns, the radii last.
inline constexpr FlankColumn kFlankColumns[] = {
    {&ToothContactTables::load_share, &FlankKinematics::load_share, "load share"},
    {&ToothContactTables::pinion_velocity_x, &FlankKinematics::pinion_velocity_x, "A_up"},
    {&ToothContactTables::pinion_velocity_y, &FlankKinematics::pinion_velocity_y, "A_vp"},
    {&ToothContactTables::gear_velocity_x, &FlankKinematics::gear_velocity_x, "A_ug"},
    {&ToothContactTables::gear_velocity_y, &FlankKinematics::gear_velocity_y, "A_vg"},
    {&ToothContactTables::contact_point_velocity_x, &FlankKinematics::contact_point_velocity_x,
     "contact point velocity x"},
    {&ToothContactTables::contact_point_velocity_y, &FlankKinematics::contact_point_velocity_y,
     "contact point velocity y"},
    {&ToothContactTables::pinion_friction_arm, &FlankKinematics::pinion_friction_arm, "r_fr,p"},
    {&ToothContactTables::gear_friction_arm, &FlankKinematics::gear_friction_arm, "r_fr,g"},
    {&ToothContactTables::radius_x, &FlankKinematics::radius_x, "R_zx", true},
    {&ToothContactTables::radius_y, &FlankKinematics::radius_y, "R_zy", true},
};

/// Sliding and lever arms of one flank pair at given speeds.
template <class Real>
struct FlankMotionOf {
  Real pinion_x, pinion_y, gear_x, gear_y;  ///< surface velocities [m/s]
  Real sliding_speed;                       ///< V_s [m/s]
  Real pinion_friction_arm;  ///< r_fr,p [m]: signed so that T_fr,p = r_fr,p F_fr adds in eq 2
  Real gear_friction_arm;    ///< r_fr,g [m]; r_fr,p phidot_p + r_fr,g phidot_g = -V_s
};
using FlankMotion = FlankMotionOf<double>;

/// Velocities and lever arms of a flank pair (core/gear/flank_motion-inl.h).
FlankMotion flank_motion(const FlankKinematics& flank, double pinion_speed, double gear_speed);

/// A gear set packed for evaluation. Immutable; safe for concurrent use; evaluation allocates
/// nothing. Tables are linear in mesh phase between their samples, shares clipped at zero and
/// scaled to add up to 1 at every sample (hence everywhere); the slopes jump at the samples only.
/// The gear set must have passed check().
class MeshData {
 public:
  explicit MeshData(const GearSet& gear_set);
  MeshData(const MeshData&) = delete;
  MeshData& operator=(const MeshData&) = delete;

  /// theta_p = N_p phi_p, theta_g = N_g phi_g [rad].
  MeshFunctions functions(double theta_p, double theta_g) const {
    return functions(at_phase(theta_p), theta_p - theta_g);
  }
  /// Valid as long as this object.
  MeshPhase at_phase(double theta_p) const;
  /// With theta_g = theta_p - lag.
  MeshFunctions functions(const MeshPhase& phase, double lag) const {
    MeshFunctions f = phase.pinion;
    const double x = phase.offset - lag;
    const auto [ripple, integral] = phase.expansion != nullptr && std::abs(x) <= reach_
                                        ? phase.expansion->at<MeshExpansion::kGearRadius, 2>(x)
                                        : gear_functions(phase, lag);
    f.gear_contact_radius += ripple;
    f.radius_integral += integral;
    return f;
  }

  /// dR_g/dlag [m/rad].
  double gear_radius_by_lag(const MeshPhase& phase, double lag) const {
    const double x = phase.offset - lag;
    if (phase.expansion != nullptr && std::abs(x) <= reach_) {
      return -phase.expansion->slope_at(MeshExpansion::kGearRadius, x);
    }
    constexpr double kStep = 1e-5;  // [rad]: error 1e-10 of the ripple of R_g, itself 4e-3 of R_g
    return (functions(phase, lag + kStep).gear_contact_radius -
            functions(phase, lag - kStep).gear_contact_radius) /
           (2 * kStep);
  }

  /// The expansion around the angle that is nearest to theta, and how far theta is from there. Null
  /// where there is none. Valid as long as this object.
  const MeshExpansion* nearest_expansion(double theta, double& offset) const;
  /// Up to which distance an expansion serves [rad]; 0: there are none.
  double series_reach() const { return reach_; }

  /// Of orders 1, 2 ... of the mesh frequency, as many as the series have.
  const std::vector<MeshOrder>& orders() const { return orders_; }

  int intervals() const { return intervals_; }  ///< of the tables per mesh cycle
  /// The interval that a phase in [0, 1] cycles is in.
  int interval_at(double phase) const {
    return std::clamp(static_cast<int>(phase * intervals_), 0, intervals_ - 1);
  }
  /// The pairs at `phase` in [0, 1] cycles, by the straight line of `interval` (continued outside
  /// it).
  void flanks(int interval, double phase, std::array<FlankKinematics, kFlankPairs>& out) const;

  int pinion_teeth() const { return pinion_teeth_; }
  int gear_teeth() const { return gear_teeth_; }
  double mean_pinion_contact_radius() const { return pinion_radius_; }
  double mean_gear_contact_radius() const { return gear_radius_; }
  double mean_mesh_stiffness() const { return stiffness_; }

 private:
  struct Harmonic {
    double radius_p_sin, radius_p_cos, radius_g_sin, radius_g_cos;
    double stiffness_sin, stiffness_cos, error_sin, error_cos;
    double pinion_order, gear_order;  // n N_p, n N_g
  };
  void expand();
  static void add(const Harmonic& harmonic, double order, double cosine, double sine,
                  MeshExpansion& to);
  std::array<double, 2> gear_functions(const MeshPhase& phase, double lag) const;
  int pinion_teeth_, gear_teeth_, intervals_;
  double pinion_radius_, gear_radius_, stiffness_, error_;
  std::vector<Harmonic> harmonics_;
  std::vector<MeshOrder> orders_;
  std::vector<MeshExpansion> expansions_;  // around even angles; empty where they would be many
  double reach_ = 0;                       // of an expansion [rad]
  std::vector<std::array<FlankKinematics, kFlankPairs>> samples_;
};

}  // namespace tribodyn
