#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/gear/gear_set.h"

namespace tribodyn {

/// Eqs 8-11 at one pair of angles, with what the closed-form transmission error and the energy
/// terms need. Slopes are per radian of phi_p.
struct MeshFunctions {
  double pinion_contact_radius;            ///< R_p [m]
  double gear_contact_radius;              ///< R_g [m]
  double radius_integral;                  ///< series part of int R_p dphi_p - int R_g dphi_g [m]
  double mesh_stiffness;                   ///< k_m [N/m]
  double mesh_stiffness_slope;             ///< dk_m/dphi_p [N/m/rad]
  double static_transmission_error;        ///< e [m]
  double static_transmission_error_slope;  ///< de/dphi_p [m/rad]
};

/// R_g's ripple and its derivatives by theta_g over k!, and the gear's part of the radius integral.
struct GearRadiusExpansion {
  static constexpr int kTerms = 9;
  std::array<double, kTerms> ripple;           ///< [m]
  std::array<double, kTerms> ripple_integral;  ///< over (k + 1) N_g [m]
  double integral;                             ///< [m]
};

/// What eqs 8-11 need of the pinion's angle alone: prepared once per phase, used at every state.
struct MeshPhase {
  double cosine, sine;   ///< of theta_p
  MeshFunctions pinion;  ///< R_g its mean, radius_integral the pinion's part
  const GearRadiusExpansion* expansion =
      nullptr;  ///< at theta_g = theta_p; saves the series of R_g
};

/// One flank pair at one mesh phase; columns of ToothContactTables.
struct FlankKinematics {
  double load_share;
  double radius_x, radius_y;
  double pinion_velocity_x, pinion_velocity_y;
  double gear_velocity_x, gear_velocity_y;
  double contact_point_velocity_x, contact_point_velocity_y;
  double pinion_friction_arm, gear_friction_arm;
};

/// Sliding and lever arms of one flank pair at given speeds.
struct FlankMotion {
  double pinion_x, pinion_y, gear_x, gear_y;  ///< surface velocities [m/s]
  double sliding_speed;                       ///< V_s [m/s]
  double pinion_friction_arm;  ///< r_fr,p [m]: signed so that T_fr,p = r_fr,p F_fr adds in eq 2
  double gear_friction_arm;    ///< r_fr,g [m]; r_fr,p phidot_p + r_fr,g phidot_g = -V_s
};

/// Velocities and lever arms r_p = -(dV . A_p)/V_s, r_g = (dV . A_g)/V_s with dV the sliding
/// vector: the power identity is exact and holds when a shaft turns backwards. Without sliding both
/// arms are 0.
FlankMotion flank_motion(const FlankKinematics& kinematics, double pinion_speed, double gear_speed);

/// A gear set packed for evaluation. Immutable; safe for concurrent use; evaluation allocates
/// nothing. Tables are linear in mesh phase between their samples, shares clipped at zero and
/// scaled to add up to 1 at every sample (hence everywhere); the slopes jump at the samples only.
/// The gear set must have passed check().
class MeshData {
 public:
  explicit MeshData(const GearSet& gear_set);

  /// theta_p = N_p phi_p, theta_g = N_g phi_g [rad].
  MeshFunctions functions(double theta_p, double theta_g) const {
    return functions(at_phase(theta_p), theta_p - theta_g);
  }
  MeshPhase at_phase(double theta_p) const;
  GearRadiusExpansion expand_gear_radius(double theta) const;
  /// With theta_g = theta_p - lag.
  MeshFunctions functions(const MeshPhase& phase, double lag) const {
    if (phase.expansion == nullptr || std::abs(lag) > longest_expanded_lag_) {
      return sum_of_series(phase, lag);
    }
    MeshFunctions f = phase.pinion;
    const GearRadiusExpansion& g = *phase.expansion;
    constexpr int kLast = GearRadiusExpansion::kTerms - 1;
    double ripple = g.ripple[kLast], integral = g.ripple_integral[kLast];
    for (int k = kLast - 1; k >= 0; --k) {
      ripple = g.ripple[k] - lag * ripple;
      integral = g.ripple_integral[k] - lag * integral;
    }
    f.gear_contact_radius += ripple;
    f.radius_integral += g.integral + lag * integral;
    return f;
  }

  int intervals() const { return intervals_; }  ///< of the tables per mesh cycle
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
    double radius_g_sin_per_order = 0, radius_g_cos_per_order = 0;  // over n N_g
  };
  MeshFunctions sum_of_series(const MeshPhase& phase, double lag) const;
  std::size_t gear_harmonics_ = 0;
  double longest_expanded_lag_ = 0;  // up to which GearRadiusExpansion is exact
  int pinion_teeth_, gear_teeth_, intervals_;
  double pinion_radius_, gear_radius_, stiffness_, error_;
  std::vector<Harmonic> harmonics_;
  std::vector<std::array<FlankKinematics, kFlankPairs>> samples_;
};

}  // namespace tribodyn
