#pragma once

#include <vector>

#include "core/driveline/gear_pair_system.h"

namespace tribodyn {

/// A motion in which flanks follow each other without inertia, at even mesh phases n / count of one
/// mesh cycle, n = 0 ... count - 1; `count` even, at least 8.
struct ImposedMotion {
  std::vector<double> mesh_approach;       ///< R_p0 phi_p - R_g0 phi_g [m]
  std::vector<double> transmission_error;  ///< x [m]
  std::vector<double> pinion_torque;       ///< left over on the pinion [N m]; empty: none
  std::vector<double> gear_torque;         ///< left over on the gear: R_g F + T_fr,g - T_w [N m]
  std::vector<double> mesh_stiffness;      ///< k_m [N/m]
  bool tail = true;                        ///< harmonics beyond the phases are wanted
  void resize(std::size_t count);
};

/// What inertia and dampers add to an imposed motion, at the same phases.
struct InertialCorrection {
  std::vector<double> transmission_error;     ///< of x [m]
  std::vector<double> transmission_velocity;  ///< xdot with the correction [m/s]
  std::vector<double> pinion_speed;           ///< of phidot_p [rad/s]
  std::vector<double> pinion_shaft_speed;     ///< of phidot_s [rad/s]
  double largest = 0;                         ///< |of x|, over the phases [m]
  /// Ratio of successive terms of the Neumann series in the stiffness ripple; only the first term
  /// is added. From 1 on the series diverges, and the correction is void.
  double growth = 0;
  /// Bound of |of x| by harmonics beyond the phases, which fall like 1/n^2 from the highest ones
  /// [m].
  double unresolved = 0;
};

/// Eqs 1, 2, 3, 4, 5 and 6 for small vibrations about a mean, harmonic by harmonic: mean contact
/// radii and mesh stiffness, flanks that never part. With D_p, D_g the dynamic stiffnesses of the
/// two sides of the mesh (gear or pinion, its shaft and the rotor behind the shaft), w the imposed
/// mesh approach and tau the unbalanced torques of the imposed motion, the correction to x is
///   (1 + Y (k + i Omega c)) dx = -w - i Omega c Y x + R_p tau_p / D_p - R_g tau_g / D_g,
///   Y = R_p^2 / D_p + R_g^2 / D_g,
/// and once more for the force (k_m - k) dx that the ripple of the stiffness adds. A constant keeps
/// the mean force.
InertialCorrection inertial_correction(const GearPairSystem& system, double mean_pinion_speed,
                                       const ImposedMotion& motion);

/// Whether the ripple of the mesh stiffness may keep a vibration going that nothing forces:
/// a harmonic of it near twice the frequency of the mesh on its mean stiffness, and larger than the
/// mesh damper bears (Mathieu's first tongue, |n Omega / 2 omega - 1| < kappa_n / 4, and margins).
/// `stiffness`: k_m at even phases.
bool parametric_resonance_possible(const GearPairSystem& system, double mean_pinion_speed,
                                   const std::vector<double>& stiffness);

}  // namespace tribodyn
