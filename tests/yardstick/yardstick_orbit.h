// Event-exact integration of one mesh cycle with SUNDIALS CVODE, and periodic orbits by shooting.
// Reference values for the product's solvers; careful rather than fast (about 0.1 s per mesh cycle,
// 2 s per orbit).
#pragma once

#include <array>

#include "yardstick_system.h"

namespace tribodyn::yardstick {

/// State on the section phi_p = 0.
struct SectionState {
  double pinion_shaft_twist = 0.0;  ///< phi_s - phi_p, rad
  double gear_shaft_twist = 0.0;    ///< phi_g - phi_w, rad
  double pinion_shaft_speed = 0.0;  ///< rad/s
  double pinion_speed = 0.0;        ///< rad/s
  double gear_speed = 0.0;          ///< rad/s
  double gear_shaft_speed = 0.0;    ///< rad/s
  double advance_with_error = 0.0;  ///< x + e, m
};

/// Means are over time. Extremes are those of the continuous solution, one-sided values at events
/// included: dense output every 1/2000 of a cycle or finer and a parabola through the three highest
/// samples, about 1e-7 relative.
struct Extremes {
  double minimum = 0.0;
  double mean = 0.0;
  double maximum = 0.0;
};

struct MeshCycle {
  SectionState end;            ///< state at phi_p = 2 pi / N_p, moved back to phi_p = 0
  double input_torque = 0.0;   ///< T_s, N m
  double period = 0.0;         ///< time for phi_p to advance by 2 pi / N_p, s
  double vehicle_speed = 0.0;  ///< r_w (2 pi / N_g) / period, m/s
  /// P_in: T_s phi_s' in drive, -T_w phi_w' in coast, where the wheel drives.
  double rms_inefficiency = 0.0;          ///< root of the time mean of (P_friction / P_in)^2, %
  double energy_mean_inefficiency = 0.0;  ///< 100 int P_friction dt / int P_in dt, %
  Extremes transmission_error;            ///< x, m
  Extremes pinion_friction_torque;        ///< T_fr,p, N m
  double maximum_temperature = 0.0;       ///< T_c over the cycle and the loaded flanks, K
  double minimum_film_parameter = 0.0;    ///< lambda_s, -
  double maximum_pressure = 0.0;          ///< p_max, Pa
  double separated_fraction = 0.0;        ///< share of the period with |x| < b
  int mode_changes = 0;                   ///< contact events within the cycle
  long right_hand_sides = 0;              ///< evaluations of eqs 1-4
};

struct CycleOptions {
  /// Local error of every state as a fraction of its natural amplitude (twist, backlash, 1 rad/s).
  double tolerance = 1e-11;
};

/// Integrates eqs 1-4 over one mesh cycle with constant torques, restarting at every table node
/// and at every contact event. Throws std::runtime_error if CVODE fails or the pinion stops.
MeshCycle integrate_mesh_cycle(const GearPairSystem& system, const SectionState& start,
                               double input_torque, double resistive_torque,
                               const CycleOptions& options = {});

/// Quasi-static start at a speed: static wind-up, flanks pressed by T_s = T_w N_p / N_g.
SectionState quasi_static_start(const GearPairSystem& system, double vehicle_speed);

/// T_w N_p / N_g with T_w of eq 7: the input torque without friction, N m.
double frictionless_input_torque(const GearPairSystem& system, double vehicle_speed);

struct OrbitOptions {
  CycleOptions cycle;
  /// Mesh cycles marched before the first Newton step. The speeds are scaled to the prescribed mean
  /// after each, since they drift until T_s is right.
  int marching_cycles = 0;
  int maximum_iterations = 60;
  /// Accepted mismatch after one cycle, as a fraction of the natural amplitude of each unknown.
  double mismatch_tolerance = 3e-9;
  /// Finite-difference step, in the same unit.
  double difference_step = 1e-4;
};

struct Orbit {
  SectionState start;         ///< on the orbit, at phi_p = 0
  MeshCycle cycle;            ///< one period from `start`
  double mismatch = 0.0;      ///< largest scaled mismatch after one cycle
  int iterations = 0;         ///< Newton corrections tried
  int integrated_cycles = 0;  ///< mesh cycles integrated in all
  bool converged = false;
};

/// Period-1 orbit at a prescribed mean vehicle speed (m/s), T_w from eq 7 at that speed, T_s
/// solved. Where orbits coexist `start` and `input_torque` decide which one is found.
Orbit find_periodic_orbit(const GearPairSystem& system, const SectionState& start,
                          double input_torque, double vehicle_speed,
                          const OrbitOptions& options = {});

}  // namespace tribodyn::yardstick
