#include "core/driveline/gear_pair_system.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numerics/square.h"

namespace tribodyn {

GearPairSystem::GearPairSystem(const MeshData& mesh, const FlankContactModel& contact,
                               const DrivelineDynamics& dynamics, const ModelOptions& options)
    : mesh_(mesh),
      contact_(contact),
      dynamics_(dynamics),
      options_(options),
      inverse_{1 / dynamics.pinion_shaft_inertia, 1 / dynamics.pinion_inertia,
               1 / dynamics.gear_inertia, 1 / dynamics.wheel_inertia},
      lag_per_approach_(mesh.gear_teeth() / mesh.mean_gear_contact_radius()),
      cycle_angle_(2 * std::numbers::pi / mesh.pinion_teeth()) {}

MeshPhase GearPairSystem::at_phase(double phase) const {
  return mesh_.at_phase(2 * std::numbers::pi * phase);
}

ContactRegime GearPairSystem::regime_of(double phase, const double* y) const {
  Mechanics at;
  kinematics(phase, y, at);
  ContactRegime r;
  const double b = dynamics_.half_backlash;
  r.side = at.transmission_error >= b ? 1 : at.transmission_error <= -b ? -1 : 0;
  const double force = at.mesh.mesh_stiffness * (at.transmission_error - r.side * b) +
                       dynamics_.mesh_damping * at.transmission_velocity;
  r.loaded = r.side != 0 && r.side * force > 0;
  return r;
}

std::array<double, 2> GearPairSystem::events(const MeshPhase& phase, const double* y, double length,
                                             double force) const {
  Mechanics at;
  kinematics(phase, y, at);
  const double b = dynamics_.half_backlash;
  if (regime.side == 0) {
    return {(at.transmission_error - b) / length, (-b - at.transmission_error) / length};
  }
  const double pressing = regime.side * at.mesh_force / force;
  return {(b - regime.side * at.transmission_error) / length, regime.loaded ? -pressing : pressing};
}

bool GearPairSystem::change_regime(int event, const MeshPhase& phase, const double* y) {
  if (regime.side == 0) {
    regime.side = event == 0 ? 1 : -1;
  } else if (event == 1) {
    regime.loaded = !regime.loaded;
    return regime.loaded;
  } else {
    regime.side = dynamics_.half_backlash > 0 ? 0 : -regime.side;
  }
  Mechanics at;
  kinematics(phase, y, at);
  // Deflection is nothing here; the damper alone decides whether load starts at once.
  regime.loaded =
      regime.side != 0 && regime.side * at.transmission_velocity > 0 && dynamics_.mesh_damping > 0;
  return false;
}

void GearPairSystem::solve_together(const FlankContactBatch* contacts) {
  together_ = contacts;
  if (contacts != nullptr) {
    geometries_.emplace(contact_.reduced_modulus(), contact_.options(), kFlankPairs);
  }
}

void GearPairSystem::solve_contacts(const std::array<ContactConditions, kFlankPairs>& conditions,
                                    Instant& out) {
  if (together_ == nullptr) {
    for (int k = 0; k < kFlankPairs; ++k) {
      if (out.load[k] > 0) out.contact[k] = contact_.solve(conditions[k]);
    }
    return;
  }
  std::array<double, kFlankPairs> pinion_x, pinion_y, gear_x, gear_y;
  for (int k = 0; k < kFlankPairs; ++k) {
    const ContactConditions& c = conditions[k];
    pinion_x[k] = c.velocity_1_x;
    pinion_y[k] = c.velocity_1_y;
    gear_x[k] = c.velocity_2_x;
    gear_y[k] = c.velocity_2_y;
    if (out.load[k] > 0) geometries_->set(k, c.radius_x, c.radius_y);
  }
  using Column = std::array<double, kFlankPairs>;
  Column friction, viscous, boundary, temperature, film, ratio, pressure, rate, stress, share,
      asperities;
  std::array<bool, kFlankPairs> at_centre;
  std::array<ContactStatus, kFlankPairs> status;
  FlankContactBatchResults results;
  results.friction = friction.data();
  results.viscous_friction = viscous.data();
  results.boundary_friction = boundary.data();
  results.contact_temperature = temperature.data();
  results.central_film_thickness = film.data();
  results.film_ratio = ratio.data();
  results.maximum_pressure = pressure.data();
  results.shear_rate = rate.data();
  results.mean_shear_stress = stress.data();
  results.limiting_stress_area_share = share.data();
  results.asperity_load = asperities.data();
  results.limiting_stress_at_centre = at_centre.data();
  results.status = status.data();
  together_->solve(
      *geometries_, 0, kFlankPairs,
      {out.load.data(), pinion_x.data(), pinion_y.data(), gear_x.data(), gear_y.data()}, results);
  for (int k = 0; k < kFlankPairs; ++k) {
    if (!(out.load[k] > 0)) continue;
    ContactFigures& contact = out.contact[k];
    contact = {};
    contact.status = status[k];
    contact.friction = friction[k];
    contact.viscous_friction = viscous[k];
    contact.boundary_friction = boundary[k];
    contact.contact_temperature = temperature[k];
    contact.central_film_thickness = film[k];
    contact.film_ratio = ratio[k];
    contact.maximum_pressure = pressure[k];
    contact.shear_rate = rate[k];
    contact.limiting_stress_area_share = share[k];
    contact.limiting_stress_at_centre = at_centre[k];
    contact.mean_shear_stress = stress[k];
    contact.asperity_load = asperities[k];
    contact_.complete(conditions[k], contact);
  }
}

void GearPairSystem::evaluate(double phase, const double* y, Instant& out) {
  mechanics(phase, y, out);

  std::array<FlankKinematics, kFlankPairs> flanks;
  mesh_.flanks(interval_, phase, flanks);
  const double load = regime.load(out.mesh_force);
  std::array<ContactConditions, kFlankPairs> conditions{};
  for (int k = 0; k < kFlankPairs; ++k) {
    out.load[k] = flanks[k].load_share * load;
    if (out.load[k] > 0) {
      ++contact_solutions_;
      conditions[k] = contact_conditions(flanks[k], out.load[k], y, out.motion[k]);
    } else {
      out.load[k] = 0;
      out.contact[k] = ContactFigures{};
      out.motion[k] = FlankMotion{};
    }
  }
  solve_contacts(conditions, out);
  for (int k = 0; k < kFlankPairs; ++k) {
    if (!(out.load[k] > 0)) continue;
    const ContactFigures& contact = out.contact[k];
    const FlankMotion& motion = out.motion[k];
    if (contact.status != ContactStatus::kOk) refuse(contact.status);
    out.pinion_friction_torque += motion.pinion_friction_arm * contact.friction;  // (eq 29)
    out.gear_friction_torque += motion.gear_friction_arm * contact.friction;
    out.loss_power += motion.sliding_speed * contact.friction;
  }
}

void GearPairSystem::derivative(const double* y, const Instant& at, bool record, double* dy) const {
  motion(y, at, dy);
  const DrivelineDynamics& d = dynamics_;
  dy[kLossWork] = at.loss_power;
  dy[kLossShareSquared] = square(at.loss_power / input_speed(y[kPinionShaftSpeed], y[kWheelSpeed]));
  int count = kMarchComponents;

  if (record) {
    count = kRecordComponents;
    for (int i = kMarchComponents; i < kRecordComponents; ++i) dy[i] = 0;
    double viscous = 0, boundary = 0;
    bool limited_centre = false;
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
      dy[kPinionSlidingLoadTime] += at.load[k] * std::min(c.specific_sliding.surface_1, 1e300);
      dy[kGearSlidingLoadTime] += at.load[k] * std::min(c.specific_sliding.surface_2, 1e300);
      dy[kLimitedAreaLoadTime] += at.load[k] * c.limiting_stress_area_share;
      limited_centre = limited_centre || c.limiting_stress_at_centre;
    }
    dy[kViscousForceSquared] = square(viscous);
    dy[kBoundaryForceSquared] = square(boundary);
    dy[kTransmissionErrorTime] = at.transmission_error;
    dy[kMeshForceTime] = at.mesh_force;
    dy[kPinionFrictionTorqueTime] = at.pinion_friction_torque;
    dy[kGearFrictionTorqueTime] = at.gear_friction_torque;
    dy[kLimitedCentreTime] = limited_centre ? 1 : 0;
    dy[kGapTime] = regime.side == 0 ? 1 : 0;
    dy[kCoastTime] = regime.side < 0 ? 1 : 0;
    dy[kPinionShaftAngle] = y[kPinionShaftSpeed];
    dy[kWheelAngle] = y[kWheelSpeed];
    dy[kShaftDampingWork] =
        d.pinion_shaft_damping * square(y[kPinionShaftSpeed] - y[kPinionSpeed]) +
        d.gear_shaft_damping * square(y[kGearSpeed] - y[kWheelSpeed]);
    dy[kMeshDampingWork] = at.damper_force * at.transmission_velocity;
    if (!options_.energy_consistent) dy[kParametricWork] = at.parametric_torque() * y[kPinionSpeed];
  }
  const double time_per_phase = cycle_angle_ / y[kPinionSpeed];
  for (int i = kLossWork; i < count; ++i) dy[i] *= time_per_phase;
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
  const double lag = mesh_.gear_teeth() / mesh_.mean_gear_contact_radius();
  double approach = section.mesh_deflection - dynamics_.half_backlash;
  for (int i = 0; i < 60; ++i) {
    const double next = section.mesh_deflection - dynamics_.half_backlash -
                        mesh_.functions(0, -lag * approach).radius_integral;
    const bool done = std::abs(next - approach) <= 1e-20 + 1e-16 * std::abs(approach);
    approach = next;
    if (done) break;
  }
  y[kMeshApproach] = approach;
  y[kLossWork] = y[kLossShareSquared] = 0;
}

SectionState GearPairSystem::to_section(const double* y) const {
  const double lag = mesh_.gear_teeth() / mesh_.mean_gear_contact_radius();
  return {y[kPinionShaftTwist],
          y[kGearShaftTwist],
          y[kPinionShaftSpeed],
          y[kPinionSpeed],
          y[kGearSpeed],
          y[kWheelSpeed],
          dynamics_.half_backlash + y[kMeshApproach] +
              mesh_.functions(0, -lag * y[kMeshApproach]).radius_integral};
}

double GearPairSystem::stored_energy(double phase, const double* y) const {
  const DrivelineDynamics& d = dynamics_;
  Mechanics at;
  kinematics(phase, y, at);
  return 0.5 * (d.pinion_shaft_inertia * square(y[kPinionShaftSpeed]) +
                d.pinion_inertia * square(y[kPinionSpeed]) +
                d.gear_inertia * square(y[kGearSpeed]) + d.wheel_inertia * square(y[kWheelSpeed]) +
                d.pinion_shaft_stiffness * square(y[kPinionShaftTwist]) +
                d.gear_shaft_stiffness * square(y[kGearShaftTwist]) +
                at.mesh.mesh_stiffness * square(at.deflection));
}

}  // namespace tribodyn
