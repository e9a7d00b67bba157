#pragma once

#include <vector>

#include "core/driveline/gear_pair_system.h"

namespace tribodyn {

/// Harmonics of the mesh frequency that a correction has at most.
inline constexpr int kMostCorrectedHarmonics = 96;

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

/// The response of eqs 1, 2, 3, 4, 5 and 6 to an imposed motion, linear about a mean: mean contact
/// radii and mesh stiffness, flanks that never part.
///  1. The imposed motion is expanded into harmonics, up to kMostCorrectedHarmonics and fewer than half of the
///     phases.
///  2. With D_p, D_g the dynamic stiffnesses of the two sides of the mesh (gear or pinion, its
///     shaft and the rotor behind the shaft), w the imposed mesh approach and tau the unbalanced
///     torques of the imposed motion, each harmonic of the correction to x is the solution of
///       (1 + Y (k + i Omega c)) dx = -w - i Omega c Y x + R_p tau_p / D_p - R_g tau_g / D_g,
///       Y = R_p^2 / D_p + R_g^2 / D_g.
///  3. The force (k_m - k) dx of the stiffness ripple is formed phase by phase and its response
///     added: one term of a Neumann series. A constant keeps the mean force.
///  4. Harmonics beyond are bounded by c / h^2, c from the highest quarter, times their response,
///     up to 1.5 times the frequency of the mesh.
/// (A. H. Nayfeh and D. T. Mook, Nonlinear Oscillations, 1979, chapter 6, for systems of several
/// degrees of freedom.)
InertialCorrection inertial_correction(const GearPairSystem& system, double mean_pinion_speed,
                                       const ImposedMotion& motion);

/// Whether the ripple of the mesh stiffness may keep a vibration going that nothing forces. The
/// mesh is taken as one oscillator of frequency omega on the mean stiffness and of damping zeta of
/// the critical one; each harmonic n of the ripple, kappa_n of the mean stiffness, alone makes it
/// Mathieu's equation with damping. Its first tongue of instability is, for small kappa_n,
///   |n Omega / (2 omega) - 1| < kappa_n / 4, if kappa_n > 4 zeta.
/// Returns true inside of a wider region: twice the width and 0.03 more, from half of that kappa_n
/// on. (A. H. Nayfeh and D. T. Mook, Nonlinear Oscillations, 1979, chapter 5.) `stiffness`: k_m at
/// even phases.
bool parametric_resonance_possible(const GearPairSystem& system, double mean_pinion_speed,
                                   const std::vector<double>& stiffness);

}  // namespace tribodyn
