#pragma once

#include <algorithm>
#include <array>

#include "core/driveline/contact_solver.h"
#include "core/driveline/frozen_friction.h"
#include "core/driveline/motion.h"
#include "core/driveline/section_state.h"
#include "core/gear/mesh_data.h"
#include "core/model_options.h"

namespace tribodyn {

/// Integrals that only a recorded march carries, after the components above.
enum RecordComponent {
  kFlankViscousWork0 = kMarchComponents,  ///< one per slot [J]
  kFlankBoundaryWork0 = kFlankViscousWork0 + kFlankPairs,
  kFlankLoadTime0 = kFlankBoundaryWork0 + kFlankPairs,       ///< one per slot: int W dt [N s]
  kFlankFrictionTime0 = kFlankLoadTime0 + kFlankPairs,       ///< one per slot: int F_fr dt [N s]
  kViscousForceSquared = kFlankFrictionTime0 + kFlankPairs,  ///< [N2 s]
  kBoundaryForceSquared,
  kTransmissionErrorTime,  ///< int x dt
  kMeshForceTime,
  kPinionFrictionTorqueTime,
  kGearFrictionTorqueTime,
  kLoadTime,  ///< int sum W dt, weight of the following
  kFilmLoadTime,
  kFilmRatioLoadTime,
  kTemperatureLoadTime,
  kPressureLoadTime,
  kShearRateLoadTime,
  kFlashLoadTime,
  kPinionSlidingLoadTime,
  kGearSlidingLoadTime,
  kLimitedAreaLoadTime,
  kGapTime,
  kCoastTime,
  kPinionShaftAngle,  ///< int phidot_s dt
  kWheelAngle,
  kShaftDampingWork,
  kMeshDampingWork,
  kParametricWork,
  kRecordComponents
};

/// Which flanks touch. `loaded` is false where c xdot pulls the mesh force below zero: the flanks
/// still touch, the friction is off.
struct ContactRegime {
  int side = 1;  ///< +1 drive flanks, 0 gap, -1 coast flanks
  bool loaded = true;
  /// What presses the flanks together under a mesh force [N]: what the contacts share.
  double load(double mesh_force) const {
    return side != 0 && loaded ? std::max(0.0, side * mesh_force) : 0;
  }
  bool operator==(const ContactRegime&) const = default;
};

struct Torques {
  double pinion = 0;  ///< T_s [N m]
  double wheel = 0;   ///< T_w [N m]
};

/// A point of the Poincare section at mesh phase 0, and the torques that hold from there on.
struct SectionPoint {
  MarchState state{};
  ContactRegime regime;
  Torques torques;
};

/// The power that comes in, which eq 30 divides by, as a torque at the pinion [N m]. In drive power
/// comes in at the pinion: T_s. In coast (T_s < 0) it comes in at the wheel: -T_w
/// phidot_w/phidot_s. Where friction takes all of the power it comes in at both.
/// `wheel_per_pinion_speed`: phidot_w/phidot_s.
inline double input_torque(const Torques& torques, double wheel_per_pinion_speed) {
  return std::max(torques.pinion, 0.0) + std::max(-torques.wheel * wheel_per_pinion_speed, 0.0);
}

/// Inefficiency by the RMS of the loss [%]: from the RMS over time of sum V_s F_fr / input_speed()
/// and from input_torque(), both in N m.
inline double inefficiency_rms(double loss_share_rms, double input_torque) {
  return 100 * loss_share_rms / input_torque;  // (eq 30)
}

/// Everything at one instant, for records and histories.
struct Instant : Mechanics {
  std::array<double, kFlankPairs> load{};
  std::array<FlankMotion, kFlankPairs> motion{};
  std::array<ContactFigures, kFlankPairs> contact{};
};

/// The 4-DoF system of driveline/motion-inl.h on the mesh functions of gear/mesh_data.h, with the
/// friction of the flanks in the loop: a piecewise smooth system, one vector field for each contact
/// regime. Immutable, safe for concurrent use; evaluation allocates nothing and throws nothing.
class GearPairSystem {
 public:
  /// Keeps references: mesh and dynamics must outlive it.
  GearPairSystem(const MeshData& mesh, const DrivelineDynamics& dynamics,
                 const ModelOptions& options);

  /// Speed of the shaft at which power comes in (input_torque()), referred to the pinion [rad/s]:
  /// phidot_s, in coast phidot_w N_g/N_p.
  double input_speed(const Torques& torques, double pinion_shaft_speed, double wheel_speed) const {
    return torques.pinion < 0 ? wheel_speed * mesh_.gear_teeth() / mesh_.pinion_teeth()
                              : pinion_shaft_speed;
  }

  /// Regime that a state is in by its x and xdot.
  ContactRegime regime_of(double phase, const double* state) const;
  /// The point of the section that a state at mesh phase 0 is.
  SectionPoint at_section(const MarchState& state, const Torques& torques) const {
    return {state, regime_of(0, state.data()), torques};
  }
  /// Event functions of a regime, positive once their event has happened. 0: flanks part, or meet
  /// on the drive side; over `length`. 1: the load ends or begins, over `force`; or flanks meet on
  /// the coast side, over `length`.
  std::array<double, 2> events(const MeshPhase& phase, const ContactRegime& regime,
                               const double* state, double length, double force) const;
  /// The regime after event 0 or 1 of a regime.
  ContactRegime regime_after(int event, const MeshPhase& phase, ContactRegime regime,
                             const double* state) const;
  /// x, mesh force and shaft torques, without friction.
  void mechanics(double phase, const ContactRegime& regime, const double* state,
                 Mechanics& out) const {
    mechanics(at_phase(phase), regime, state, out);
  }
  void mechanics(const MeshPhase& phase, const ContactRegime& regime, const double* state,
                 Mechanics& out) const;
  /// Evaluates mechanics and the friction of each loaded flank at a mesh phase [cycles], by the
  /// straight lines of a table interval, continued outside it. Returns the first refusal of a
  /// contact, kOk if there is none.
  ContactStatus evaluate(double phase, int interval, const ContactRegime& regime,
                         const double* state, ContactSolver& contacts, Instant& out) const;
  /// The conditions of a flank's contact under `load` [N] in a state; sets its sliding and arms.
  ContactConditions contact_conditions(const FlankKinematics& flank, double load,
                                       const double* state, FlankMotion& motion) const;
  /// d state / d phase of time and the seven states of motion.
  void motion(const double* state, const Mechanics& at, const Torques& torques,
              double* derivative) const;
  /// Sets `at` to the mechanics under given friction arms, and the derivative of that motion.
  /// Callers include driveline/gear_pair_motion.h.
  inline void motion(const MeshPhase& phase, const ContactRegime& regime, const double* state,
                     const FrictionArms& friction, const Torques& torques, Mechanics& at,
                     double* derivative) const;
  /// Derivatives of that motion, exact, with the friction arms held. `at` and `derivative`: as
  /// motion() has set them.
  void slopes(const MeshPhase& phase, const ContactRegime& regime, const double* state,
              const Mechanics& at, const FrictionArms& friction, const double* derivative,
              MotionSlopes& out) const;
  /// What eq 2 leaves out: F e' - k_m' f^2/2 [N m].
  static double parametric_torque(const Mechanics& at);
  /// d state / d phase of the first kMarchComponents at an instant.
  void derivative(const double* state, const Instant& at, const Torques& torques,
                  double* derivative) const;
  /// The same of all kRecordComponents.
  void record_derivative(const double* state, const Instant& at, const ContactRegime& regime,
                         const Torques& torques, double* derivative) const;
  /// x and mesh force without friction: for events.
  void kinematics(double phase, const ContactRegime& regime, const double* state,
                  Mechanics& out) const {
    kinematics(at_phase(phase), regime, state, out);
  }
  void kinematics(const MeshPhase& phase, const ContactRegime& regime, const double* state,
                  Mechanics& out) const;
  /// dR_g/d(mesh approach) [-].
  double gear_radius_by_approach(const MeshPhase& phase, double approach) const {
    return lag_per_approach_ * mesh_.gear_radius_by_lag(phase, lag_per_approach_ * approach);
  }
  /// Mesh phase [cycles].
  MeshPhase at_phase(double phase) const;

  /// Of a vibration of the mesh on its mean stiffness, held by nothing but its rotors [rad/s].
  double mesh_frequency() const;
  double cycle_angle() const { return constants_.cycle_angle; }  ///< phi_p per mesh cycle
  void to_march(const SectionState& section, double* state) const;
  SectionState to_section(const double* state) const;
  /// Kinetic and elastic energy [J].
  double stored_energy(double phase, const ContactRegime& regime, const double* state) const;

  const MeshData& mesh() const { return mesh_; }
  const DrivelineDynamics& dynamics() const { return dynamics_; }
  const ModelOptions& options() const { return options_; }
  const MotionConstants& constants() const { return constants_; }

 private:
  // The bodies of kinematics() and mechanics(), in driveline/gear_pair_motion.h.
  inline void set_kinematics(const MeshPhase& phase, const ContactRegime& regime,
                             const double* state, Mechanics& out) const;
  inline void set_mechanics(const MeshPhase& phase, const ContactRegime& regime,
                            const double* state, Mechanics& out) const;

  const MeshData& mesh_;
  const DrivelineDynamics& dynamics_;
  ModelOptions options_;
  MotionConstants constants_;
  double lag_per_approach_;  // of N_g phi_g behind N_p phi_p [rad/m]
};

}  // namespace tribodyn
