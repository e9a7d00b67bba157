#include "core/driveline/gear_pair_system.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/driveline/gear_pair_motion.h"
#include "core/gear/flank_motion-inl.h"
#include "core/numerics/square.h"

namespace tribodyn {

GearPairSystem::GearPairSystem(const MeshData& mesh, const DrivelineDynamics& dynamics,
                               const ModelOptions& options)
    : mesh_(mesh),
      dynamics_(dynamics),
      options_(options),
      constants_{.pinion_shaft_stiffness = dynamics.pinion_shaft_stiffness,
                 .pinion_shaft_damping = dynamics.pinion_shaft_damping,
                 .gear_shaft_stiffness = dynamics.gear_shaft_stiffness,
                 .gear_shaft_damping = dynamics.gear_shaft_damping,
                 .per_pinion_shaft_inertia = 1 / dynamics.pinion_shaft_inertia,
                 .per_pinion_inertia = 1 / dynamics.pinion_inertia,
                 .per_gear_inertia = 1 / dynamics.gear_inertia,
                 .per_wheel_inertia = 1 / dynamics.wheel_inertia,
                 .mesh_damping = dynamics.mesh_damping,
                 .half_backlash = dynamics.half_backlash,
                 .pinion_radius = mesh.mean_pinion_contact_radius(),
                 .gear_radius = mesh.mean_gear_contact_radius(),
                 .cycle_angle = 2 * std::numbers::pi / mesh.pinion_teeth()},
      lag_per_approach_(mesh.gear_teeth() / mesh.mean_gear_contact_radius()) {}

void GearPairSystem::kinematics(const MeshPhase& phase, const ContactRegime& regime,
                                const double* y, Mechanics& out) const {
  set_kinematics(phase, regime, y, out);
}

void GearPairSystem::mechanics(const MeshPhase& phase, const ContactRegime& regime, const double* y,
                               Mechanics& out) const {
  set_mechanics(phase, regime, y, out);
}

void GearPairSystem::motion(const double* y, const Mechanics& at, const Torques& torques,
                            double* dy) const {
  HWY_NAMESPACE::motion(constants_, options_.energy_consistent, y, at, torques.pinion,
                        torques.wheel, dy);
}

double GearPairSystem::parametric_torque(const Mechanics& at) {
  return HWY_NAMESPACE::parametric_torque(at);
}

void GearPairSystem::slopes(const MeshPhase& phase, const ContactRegime& regime, const double* y,
                            const Mechanics& at, const FrictionArms& friction, const double* dy,
                            MotionSlopes& out) const {
  const bool is_gap = regime.side == 0;
  const HWY_NAMESPACE::SlopePlace<double> place{
      .touches = !is_gap,
      .damping = is_gap && options_.damping_in_contact_only ? 0 : constants_.mesh_damping,
      .load_by_force = regime.load(at.mesh_force) > 0 ? regime.side : 0.0,
      .radius_by_approach = gear_radius_by_approach(phase, y[kMeshApproach]),
      .pinion_arm = friction.pinion,
      .gear_arm = friction.gear};
  HWY_NAMESPACE::set_motion_slopes(constants_, options_.energy_consistent, place, at, y, dy, out);
}

ContactConditions GearPairSystem::contact_conditions(const FlankKinematics& flank, double load,
                                                     const double* y, FlankMotion& motion) const {
  HWY_NAMESPACE::set_flank_motion(flank, y[kPinionSpeed], y[kGearSpeed],
                                  options_.tabulated_friction_arms, motion);
  FlankMotion by_contact = motion;  // velocities relative to the contact point
  if (options_.subtract_contact_point_motion) {
    HWY_NAMESPACE::subtract_drift(flank, y[kPinionSpeed], by_contact);
  }
  return {load,
          flank.radius_x,
          flank.radius_y,
          by_contact.pinion_x,
          by_contact.pinion_y,
          by_contact.gear_x,
          by_contact.gear_y};
}

double GearPairSystem::mesh_frequency() const {
  return std::sqrt(mesh_.mean_mesh_stiffness() *
                   (square(mesh_.mean_pinion_contact_radius()) / dynamics_.pinion_inertia +
                    square(mesh_.mean_gear_contact_radius()) / dynamics_.gear_inertia));
}

MeshPhase GearPairSystem::at_phase(double phase) const {
  return mesh_.at_phase(2 * std::numbers::pi * phase);
}

ContactRegime GearPairSystem::regime_of(double phase, const double* y) const {
  ContactRegime r;
  Mechanics at;
  kinematics(phase, r, y, at);
  const double b = dynamics_.half_backlash;
  r.side = at.transmission_error >= b ? 1 : at.transmission_error <= -b ? -1 : 0;
  const double force = at.mesh.mesh_stiffness * (at.transmission_error - r.side * b) +
                       dynamics_.mesh_damping * at.transmission_velocity;
  r.loaded = r.side != 0 && r.side * force > 0;
  return r;
}

std::array<double, 2> GearPairSystem::events(const MeshPhase& phase, const ContactRegime& regime,
                                             const double* y, double length, double force) const {
  Mechanics at;
  set_kinematics(phase, regime, y, at);
  const double b = dynamics_.half_backlash;
  if (regime.side == 0) {
    return {(at.transmission_error - b) / length, (-b - at.transmission_error) / length};
  }
  const double pressing = regime.side * at.mesh_force / force;
  return {(b - regime.side * at.transmission_error) / length, regime.loaded ? -pressing : pressing};
}

ContactRegime GearPairSystem::regime_after(int event, const MeshPhase& phase, ContactRegime r,
                                           const double* y) const {
  if (r.side == 0) {
    r.side = event == 0 ? 1 : -1;
  } else if (event == 1) {
    r.loaded = !r.loaded;
    return r;
  } else {
    r.side = dynamics_.half_backlash > 0 ? 0 : -r.side;
  }
  Mechanics at;
  kinematics(phase, r, y, at);
  // Deflection is nothing here; the damper alone decides whether load starts at once.
  r.loaded = r.side != 0 && r.side * at.transmission_velocity > 0 && dynamics_.mesh_damping > 0;
  return r;
}

ContactStatus GearPairSystem::evaluate(double phase, int interval, const ContactRegime& regime,
                                       const double* y, ContactSolver& contacts,
                                       Instant& out) const {
  mechanics(phase, regime, y, out);

  std::array<FlankKinematics, kFlankPairs> flanks;
  mesh_.flanks(interval, phase, flanks);
  const double load = regime.load(out.mesh_force);
  std::array<ContactConditions, kFlankPairs> conditions{};
  for (int k = 0; k < kFlankPairs; ++k) {
    out.load[k] = flanks[k].load_share * load;
    if (out.load[k] > 0) {
      conditions[k] = contact_conditions(flanks[k], out.load[k], y, out.motion[k]);
    } else {
      out.load[k] = 0;
      out.motion[k] = FlankMotion{};
    }
  }
  const ContactStatus refusal = contacts.solve(conditions, out.contact);
  for (int k = 0; k < kFlankPairs; ++k) {
    if (!(out.load[k] > 0)) continue;
    const FlankMotion& motion = out.motion[k];
    add_flank_friction(motion.pinion_friction_arm, motion.gear_friction_arm, motion.sliding_speed,
                       out.contact[k].friction, out);
  }
  return refusal;
}

void GearPairSystem::derivative(const double* y, const Instant& at, const Torques& torques,
                                double* dy) const {
  motion(y, at, torques, dy);
  const double time_per_phase = constants_.cycle_angle / y[kPinionSpeed];
  dy[kLossWork] = at.loss_power * time_per_phase;
  dy[kLossShareSquared] =
      square(at.loss_power / input_speed(torques, y[kPinionShaftSpeed], y[kWheelSpeed])) *
      time_per_phase;
}

void GearPairSystem::record_derivative(const double* y, const Instant& at,
                                       const ContactRegime& regime, const Torques& torques,
                                       double* dy) const {
  derivative(y, at, torques, dy);
  const DrivelineDynamics& d = dynamics_;
  for (int i = kMarchComponents; i < kRecordComponents; ++i) dy[i] = 0;
  double viscous = 0, boundary = 0;
  for (int k = 0; k < kFlankPairs; ++k) {
    if (!(at.load[k] > 0)) continue;
    const ContactFigures& c = at.contact[k];
    viscous += c.viscous_friction;
    boundary += c.boundary_friction;
    dy[kFlankViscousWork0 + k] = at.motion[k].sliding_speed * c.viscous_friction;
    dy[kFlankBoundaryWork0 + k] = at.motion[k].sliding_speed * c.boundary_friction;
    dy[kFlankLoadTime0 + k] = at.load[k];
    dy[kFlankFrictionTime0 + k] = c.friction;
    dy[kLoadTime] += at.load[k];
    dy[kFilmLoadTime] += at.load[k] * c.central_film_thickness;
    dy[kFilmRatioLoadTime] += at.load[k] * c.film_ratio;
    dy[kTemperatureLoadTime] += at.load[k] * c.contact_temperature;
    dy[kPressureLoadTime] += at.load[k] * c.maximum_pressure;
    dy[kShearRateLoadTime] += at.load[k] * std::min(c.shear_rate, 1e300);
    dy[kFlashLoadTime] += at.load[k] * c.flash_temperature_rise;
    dy[kPinionSlidingLoadTime] += at.load[k] * std::min(c.specific_sliding_1, 1e300);
    dy[kGearSlidingLoadTime] += at.load[k] * std::min(c.specific_sliding_2, 1e300);
    dy[kLimitedAreaLoadTime] += at.load[k] * c.limiting_stress_area_share;
  }
  dy[kViscousForceSquared] = square(viscous);
  dy[kBoundaryForceSquared] = square(boundary);
  dy[kTransmissionErrorTime] = at.transmission_error;
  dy[kMeshForceTime] = at.mesh_force;
  dy[kPinionFrictionTorqueTime] = at.pinion_friction_torque;
  dy[kGearFrictionTorqueTime] = at.gear_friction_torque;
  dy[kGapTime] = regime.side == 0 ? 1 : 0;
  dy[kCoastTime] = regime.side < 0 ? 1 : 0;
  dy[kPinionShaftAngle] = y[kPinionShaftSpeed];
  dy[kWheelAngle] = y[kWheelSpeed];
  dy[kShaftDampingWork] = d.pinion_shaft_damping * square(y[kPinionShaftSpeed] - y[kPinionSpeed]) +
                          d.gear_shaft_damping * square(y[kGearSpeed] - y[kWheelSpeed]);
  dy[kMeshDampingWork] = at.damper_force * at.transmission_velocity;
  if (!options_.energy_consistent) dy[kParametricWork] = parametric_torque(at) * y[kPinionSpeed];
  const double time_per_phase = constants_.cycle_angle / y[kPinionSpeed];
  for (int i = kMarchComponents; i < kRecordComponents; ++i) dy[i] *= time_per_phase;
}

void GearPairSystem::to_march(const SectionState& section, double* y) const {
  y[kTime] = 0;
  y[kPinionShaftTwist] = section.pinion_shaft_twist;
  y[kGearShaftTwist] = section.gear_shaft_twist;
  y[kPinionShaftSpeed] = section.pinion_shaft_speed;
  y[kPinionSpeed] = section.pinion_speed;
  y[kGearSpeed] = section.gear_speed;
  y[kWheelSpeed] = section.wheel_speed;
  // b + mesh approach + radius_integral(0, mesh approach) = deflection: a contraction by R_g's
  // ripple, 1e-2.
  double approach = section.mesh_deflection - dynamics_.half_backlash;
  for (int i = 0; i < 60; ++i) {
    const double next = section.mesh_deflection - dynamics_.half_backlash -
                        mesh_.functions(0, -lag_per_approach_ * approach).radius_integral;
    const bool done = std::abs(next - approach) <= 1e-20 + 1e-16 * std::abs(approach);
    approach = next;
    if (done) break;
  }
  y[kMeshApproach] = approach;
  y[kLossWork] = y[kLossShareSquared] = 0;
}

SectionState GearPairSystem::to_section(const double* y) const {
  return {y[kPinionShaftTwist],
          y[kGearShaftTwist],
          y[kPinionShaftSpeed],
          y[kPinionSpeed],
          y[kGearSpeed],
          y[kWheelSpeed],
          dynamics_.half_backlash + y[kMeshApproach] +
              mesh_.functions(0, -lag_per_approach_ * y[kMeshApproach]).radius_integral};
}

double GearPairSystem::stored_energy(double phase, const ContactRegime& regime,
                                     const double* y) const {
  const DrivelineDynamics& d = dynamics_;
  Mechanics at;
  kinematics(phase, regime, y, at);
  return 0.5 * (d.pinion_shaft_inertia * square(y[kPinionShaftSpeed]) +
                d.pinion_inertia * square(y[kPinionSpeed]) +
                d.gear_inertia * square(y[kGearSpeed]) + d.wheel_inertia * square(y[kWheelSpeed]) +
                d.pinion_shaft_stiffness * square(y[kPinionShaftTwist]) +
                d.gear_shaft_stiffness * square(y[kGearShaftTwist]) +
                at.mesh.mesh_stiffness * square(at.deflection));
}

}  // namespace tribodyn
