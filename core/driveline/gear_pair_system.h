#pragma once

#include <algorithm>
#include <array>

#include "core/driveline/contact_solver.h"
#include "core/driveline/section_state.h"
#include "core/gear/mesh_data.h"
#include "core/model_options.h"

namespace tribodyn {

/// State of the march over mesh phase. The pinion angle is the independent variable, so that the
/// samples of the tooth contact tables and the mesh cycle fall on known places; time is a
/// component. Twists and the mesh approach are differences of angles and stay small.
enum MarchComponent {
  kTime,              ///< [s] since the section
  kPinionShaftTwist,  ///< phi_s - phi_p [rad]
  kMeshApproach,      ///< R_p0 phi_p - R_g0 phi_g [m]
  kGearShaftTwist,    ///< phi_g - phi_w [rad]
  kPinionShaftSpeed,  ///< [rad/s]
  kPinionSpeed,
  kGearSpeed,
  kWheelSpeed,
  kLossWork,  ///< int sum V_s F_fr dt [J]
  /// int (sum V_s F_fr / input_speed())^2 dt [(N m)^2 s]: eq 30's RMS but for the torque
  kLossShareSquared,
  kMarchComponents
};

using MarchState = std::array<double, kMarchComponents>;

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
  kLimitedCentreTime,
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

template <class Real>
struct TorquesOf {
  Real pinion = 0;  ///< T_s [N m]
  Real wheel = 0;   ///< T_w [N m]
};
using Torques = TorquesOf<double>;

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

/// Forces and torques at one instant. Real: double, or a dual number (core/numerics/dual-inl.h).
template <class Real>
struct MechanicsOf {
  MeshFunctionsOf<Real> mesh;
  Real deflection;             ///< f [m]
  Real transmission_error;     ///< x [m]
  Real transmission_velocity;  ///< xdot [m/s]
  Real mesh_force;             ///< k_m f + c xdot [N]; of which the damper:
  Real damper_force;
  Real pinion_shaft_torque;  ///< [N m]
  Real gear_shaft_torque;
  Real pinion_friction_torque;
  Real gear_friction_torque;
  Real loss_power;  ///< sum V_s F_fr [W]
  /// What eq 2 leaves out: F e' - k_m' f^2/2 [N m].
  Real parametric_torque() const {
    return mesh_force * mesh.static_transmission_error_slope -
           0.5 * mesh.mesh_stiffness_slope * deflection * deflection;
  }
};
using Mechanics = MechanicsOf<double>;

/// Everything at one instant, for records and histories.
struct Instant : Mechanics {
  std::array<double, kFlankPairs> load{};
  std::array<FlankMotion, kFlankPairs> motion{};
  std::array<ContactFigures, kFlankPairs> contact{};
};

/// The 4-DoF system of eqs 1 to 6 on the mesh functions of eqs 8 to 11, with friction (eqs 28, 29)
/// in the loop: a piecewise smooth system, one vector field for each contact regime. Immutable,
/// safe for concurrent use; evaluation allocates nothing and throws nothing.
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
  template <class Real>
  void mechanics(const MeshPhase& phase, const ContactRegime& regime, const Real* state,
                 MechanicsOf<Real>& out) const;
  /// Evaluates mechanics and the friction of each loaded flank at a mesh phase [cycles], by the
  /// straight lines of a table interval, continued outside it. Returns the first refusal of a
  /// contact, kOk if there is none.
  ContactStatus evaluate(double phase, int interval, const ContactRegime& regime,
                         const double* state, ContactSolver& contacts, Instant& out) const;
  /// The conditions of a flank's contact under `load` [N] in a state; sets its sliding and arms.
  ContactConditions contact_conditions(const FlankKinematics& flank, double load,
                                       const double* state, FlankMotion& motion) const;
  /// d state / d phase of time and the seven states of motion.
  template <class Real>
  void motion(const Real* state, const MechanicsOf<Real>& at, const TorquesOf<Real>& torques,
              Real* derivative) const;
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
  template <class Real>
  void kinematics(const MeshPhase& phase, const ContactRegime& regime, const Real* state,
                  MechanicsOf<Real>& out) const;
  /// dR_g/d(mesh approach) [-].
  double gear_radius_by_approach(const MeshPhase& phase, double approach) const {
    return lag_per_approach_ * mesh_.gear_radius_by_lag(phase, lag_per_approach_ * approach);
  }
  /// Mesh phase [cycles].
  MeshPhase at_phase(double phase) const;

  /// Of a vibration of the mesh on its mean stiffness, held by nothing but its rotors [rad/s].
  double mesh_frequency() const;
  double cycle_angle() const { return cycle_angle_; }  ///< phi_p per mesh cycle, 2 pi/N_p
  void to_march(const SectionState& section, double* state) const;
  SectionState to_section(const double* state) const;
  /// Kinetic and elastic energy [J].
  double stored_energy(double phase, const ContactRegime& regime, const double* state) const;

  const MeshData& mesh() const { return mesh_; }
  const DrivelineDynamics& dynamics() const { return dynamics_; }
  const ModelOptions& options() const { return options_; }

 private:
  const MeshData& mesh_;
  const DrivelineDynamics& dynamics_;
  ModelOptions options_;
  struct Inverse {
    double pinion_shaft_inertia, pinion_inertia, gear_inertia, wheel_inertia;
  } inverse_;
  double lag_per_approach_;  // of N_g phi_g behind N_p phi_p [rad/m]
  double cycle_angle_;
};

template <class Real>
void GearPairSystem::kinematics(const MeshPhase& phase, const ContactRegime& regime, const Real* y,
                                MechanicsOf<Real>& out) const {
  // N_g phi_g = N_p phi_p - N_g (mesh approach)/R_g0, because R_g0 N_p = R_p0 N_g.
  out.mesh = mesh_.functions(phase, lag_per_approach_ * y[kMeshApproach]);
  const MeshFunctionsOf<Real>& m = out.mesh;
  const double b = dynamics_.half_backlash;
  out.transmission_error =
      b + y[kMeshApproach] + m.radius_integral - m.static_transmission_error;  // (eq 6)
  out.transmission_velocity =
      (m.pinion_contact_radius - m.static_transmission_error_slope) * y[kPinionSpeed] -
      m.gear_contact_radius * y[kGearSpeed];
  out.deflection =
      regime.side == 0 ? Real(0.0) : out.transmission_error - regime.side * b;  // (eq 5)
  out.damper_force = regime.side == 0 && options_.damping_in_contact_only
                         ? Real(0.0)
                         : dynamics_.mesh_damping * out.transmission_velocity;
  out.mesh_force = m.mesh_stiffness * out.deflection + out.damper_force;
}

template <class Real>
void GearPairSystem::mechanics(const MeshPhase& phase, const ContactRegime& regime, const Real* y,
                               MechanicsOf<Real>& out) const {
  kinematics(phase, regime, y, out);
  const DrivelineDynamics& d = dynamics_;
  out.pinion_shaft_torque = d.pinion_shaft_stiffness * y[kPinionShaftTwist] +
                            d.pinion_shaft_damping * (y[kPinionShaftSpeed] - y[kPinionSpeed]);
  out.gear_shaft_torque = d.gear_shaft_stiffness * y[kGearShaftTwist] +
                          d.gear_shaft_damping * (y[kGearSpeed] - y[kWheelSpeed]);
  out.pinion_friction_torque = out.gear_friction_torque = out.loss_power = 0;
}

inline ContactConditions GearPairSystem::contact_conditions(const FlankKinematics& flank,
                                                            double load, const double* y,
                                                            FlankMotion& motion) const {
  motion = flank_motion(flank, y[kPinionSpeed], y[kGearSpeed]);
  if (options_.tabulated_friction_arms) {
    motion.pinion_friction_arm = flank.pinion_friction_arm;
    motion.gear_friction_arm = flank.gear_friction_arm;
  }
  double drift_x = 0, drift_y = 0;
  if (options_.subtract_contact_point_motion) {
    drift_x = flank.contact_point_velocity_x * y[kPinionSpeed];
    drift_y = flank.contact_point_velocity_y * y[kPinionSpeed];
  }
  return {load,
          flank.radius_x,
          flank.radius_y,
          motion.pinion_x - drift_x,
          motion.pinion_y - drift_y,
          motion.gear_x - drift_x,
          motion.gear_y - drift_y};
}

template <class Real>
void GearPairSystem::motion(const Real* y, const MechanicsOf<Real>& at,
                            const TorquesOf<Real>& torques, Real* dy) const {
  const MeshFunctionsOf<Real>& m = at.mesh;
  Real pinion_torque =
      -m.pinion_contact_radius * at.mesh_force + at.pinion_shaft_torque + at.pinion_friction_torque;
  if (options_.energy_consistent) pinion_torque = pinion_torque + at.parametric_torque();
  const Real gear_torque =
      m.gear_contact_radius * at.mesh_force - at.gear_shaft_torque + at.gear_friction_torque;
  const Real time = cycle_angle_ / y[kPinionSpeed];
  dy[kTime] = time;
  dy[kPinionShaftTwist] = time * (y[kPinionShaftSpeed] - y[kPinionSpeed]);
  dy[kMeshApproach] = time * (mesh_.mean_pinion_contact_radius() * y[kPinionSpeed] -
                              mesh_.mean_gear_contact_radius() * y[kGearSpeed]);
  dy[kGearShaftTwist] = time * (y[kGearSpeed] - y[kWheelSpeed]);
  const Real pinion_shaft_torque = torques.pinion - at.pinion_shaft_torque;
  const Real wheel_torque = at.gear_shaft_torque - torques.wheel;
  dy[kPinionShaftSpeed] = time * (pinion_shaft_torque * inverse_.pinion_shaft_inertia);  // (eq 1)
  dy[kPinionSpeed] = time * (pinion_torque * inverse_.pinion_inertia);                   // (eq 2)
  dy[kGearSpeed] = time * (gear_torque * inverse_.gear_inertia);                         // (eq 3)
  dy[kWheelSpeed] = time * (wheel_torque * inverse_.wheel_inertia);                      // (eq 4)
}

}  // namespace tribodyn
