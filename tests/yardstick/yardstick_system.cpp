#include "yardstick_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace tribodyn::yardstick {

double FourierSeries::value(double angle) const {
  double sum = constant;
  for (int i = 0; i < kHarmonics; ++i) {
    sum += sine[i] * std::sin((i + 1) * angle) + cosine[i] * std::cos((i + 1) * angle);
  }
  return sum;
}

double FourierSeries::derivative(double angle) const {
  double sum = 0.0;
  for (int i = 0; i < kHarmonics; ++i) {
    sum += (i + 1) * (sine[i] * std::cos((i + 1) * angle) - cosine[i] * std::sin((i + 1) * angle));
  }
  return sum;
}

double FourierSeries::oscillating_integral(double angle) const {
  double sum = 0.0;
  for (int i = 0; i < kHarmonics; ++i) {
    sum += (cosine[i] * std::sin((i + 1) * angle) - sine[i] * std::cos((i + 1) * angle)) / (i + 1);
  }
  return sum;
}

double resistive_torque(const VehicleParameters& vehicle, double vehicle_speed_meters_per_second) {
  const double weight = vehicle.mass * vehicle.gravity;
  return vehicle.wheel_radius *
         (weight * vehicle.rolling_resistance * std::cos(vehicle.ascent_angle) +
          weight * std::sin(vehicle.ascent_angle) + vehicle.mass * vehicle.acceleration +
          vehicle.drag_coefficient * vehicle.frontal_area * 0.5 * vehicle.air_density *
              vehicle_speed_meters_per_second * vehicle_speed_meters_per_second);
}

GearPairSystem::GearPairSystem(const GearPairParameters& gear_pair,
                               const VehicleParameters& vehicle, const ContactFriction& friction,
                               FrictionArms arms)
    : gear_pair_(gear_pair), vehicle_(vehicle), friction_(friction), arms_(arms) {
  const double exact =
      gear_pair_.pinion_contact_radius.constant * gear_pair_.gear_teeth / gear_pair_.pinion_teeth;
  if (std::abs(gear_pair_.gear_contact_radius.constant / exact - 1.0) > 1e-12) {
    throw std::invalid_argument("R_g0 differs from R_p0 N_g / N_p");
  }
  gear_pair_.gear_contact_radius.constant = exact;
}

double GearPairSystem::gear_angle(const State& state) const {
  return (gear_pair_.pinion_contact_radius.constant * state[kPinionAngle] - state[kMeshAdvance]) /
         gear_pair_.gear_contact_radius.constant;
}

double GearPairSystem::advance_with_error(const State& state) const {
  const double pinion_phase = gear_pair_.pinion_teeth * state[kPinionAngle];
  const double gear_phase = gear_pair_.gear_teeth * gear_angle(state);
  return gear_pair_.half_backlash + state[kMeshAdvance] +
         gear_pair_.pinion_contact_radius.oscillating_integral(pinion_phase) /
             gear_pair_.pinion_teeth -
         gear_pair_.gear_contact_radius.oscillating_integral(gear_phase) / gear_pair_.gear_teeth;
}

double GearPairSystem::mesh_advance_at_section(double target) const {
  State state{};
  const auto mismatch = [&](double advance) {
    state[kMeshAdvance] = advance;
    return advance_with_error(state) - target;
  };
  const double guess = target - gear_pair_.half_backlash;
  const double margin = std::abs(guess) + gear_pair_.half_backlash;
  return find_root(mismatch, guess - margin, guess + margin);
}

double GearPairSystem::pinion_angle_at_node(int node) const {
  return 2.0 * std::numbers::pi * node / (kIntervals * gear_pair_.pinion_teeth);
}

Instant GearPairSystem::evaluate(const State& state, int interval, ContactMode mode,
                                 double input_torque, double resistive_torque) const {
  const GearPairParameters& gear = gear_pair_;
  Instant now;
  now.maximum_temperature = -std::numeric_limits<double>::infinity();
  now.minimum_film_parameter = std::numeric_limits<double>::infinity();

  const double pinion_phase = gear.pinion_teeth * state[kPinionAngle];
  const double gear_phase = gear.gear_teeth * gear_angle(state);
  const double pinion_radius = gear.pinion_contact_radius.value(pinion_phase);
  const double gear_radius = gear.gear_contact_radius.value(gear_phase);
  now.transmission_error =
      advance_with_error(state) - gear.static_transmission_error.value(pinion_phase);
  now.transmission_error_rate = pinion_radius * state[kPinionSpeed] -
                                gear_radius * state[kGearSpeed] -
                                gear.static_transmission_error.derivative(pinion_phase) *
                                    gear.pinion_teeth * state[kPinionSpeed];

  double backlash_function = 0.0;  // f of eq 5
  double pressing = 0.0;           // sign with which the mesh force loads the flanks
  switch (mode) {
    case ContactMode::kDriveLoaded:
      pressing = 1.0;
      [[fallthrough]];
    case ContactMode::kDriveUnloaded:
      backlash_function = now.transmission_error - gear.half_backlash;
      break;
    case ContactMode::kCoastLoaded:
      pressing = -1.0;
      [[fallthrough]];
    case ContactMode::kCoastUnloaded:
      backlash_function = now.transmission_error + gear.half_backlash;
      break;
    case ContactMode::kSeparated:
      break;
  }
  now.mesh_force = gear.mesh_stiffness.value(pinion_phase) * backlash_function +
                   gear.mesh_damping * now.transmission_error_rate;
  add_flank_friction(state, interval, pressing * now.mesh_force, &now);

  const double pinion_shaft_torque =
      gear.pinion_shaft_stiffness * state[kPinionShaftTwist] +
      gear.pinion_shaft_damping * (state[kPinionShaftSpeed] - state[kPinionSpeed]);
  const double gear_shaft_torque =
      gear.gear_shaft_stiffness * state[kGearShaftTwist] +
      gear.gear_shaft_damping * (state[kGearSpeed] - state[kGearShaftSpeed]);
  now.rate[kPinionShaftTwist] = state[kPinionShaftSpeed] - state[kPinionSpeed];
  now.rate[kPinionAngle] = state[kPinionSpeed];
  now.rate[kMeshAdvance] = gear.pinion_contact_radius.constant * state[kPinionSpeed] -
                           gear.gear_contact_radius.constant * state[kGearSpeed];
  now.rate[kGearShaftTwist] = state[kGearSpeed] - state[kGearShaftSpeed];
  now.rate[kPinionShaftSpeed] =
      (-pinion_shaft_torque + input_torque) / gear.pinion_shaft_inertia;  // eq 1
  now.rate[kPinionSpeed] =
      (-pinion_radius * now.mesh_force + pinion_shaft_torque + now.pinion_friction_torque) /
      gear.pinion_inertia;  // eq 2
  now.rate[kGearSpeed] =
      (gear_radius * now.mesh_force - gear_shaft_torque + now.gear_friction_torque) /
      gear.gear_inertia;  // eq 3
  now.rate[kGearShaftSpeed] = (gear_shaft_torque - resistive_torque) / gear.gear_shaft_inertia;
  return now;
}

void GearPairSystem::add_flank_friction(const State& state, int interval, double flank_load,
                                        Instant* instant) const {
  if (!(flank_load > 0.0)) return;
  const double psi = gear_pair_.pinion_teeth * state[kPinionAngle] / (2.0 * std::numbers::pi);
  const double fraction = psi * kIntervals - interval;
  for (int slot = 0; slot < kSlots; ++slot) {
    const auto interpolate = [&](const SlotTable& table) {
      const double left = table[slot][interval];
      return left + fraction * (table[slot][interval + 1] - left);
    };
    ContactInput contact;
    contact.load = interpolate(gear_pair_.load_share) * flank_load;
    if (!(contact.load > 0.0)) continue;
    const double pinion_arm_x = interpolate(gear_pair_.pinion_velocity_x);
    const double pinion_arm_y = interpolate(gear_pair_.pinion_velocity_y);
    const double gear_arm_x = interpolate(gear_pair_.gear_velocity_x);
    const double gear_arm_y = interpolate(gear_pair_.gear_velocity_y);
    contact.radius_x = interpolate(gear_pair_.radius_x);
    contact.radius_y = interpolate(gear_pair_.radius_y);
    contact.pinion_velocity_x = pinion_arm_x * state[kPinionSpeed];
    contact.pinion_velocity_y = pinion_arm_y * state[kPinionSpeed];
    contact.gear_velocity_x = gear_arm_x * state[kGearSpeed];
    contact.gear_velocity_y = gear_arm_y * state[kGearSpeed];
    const ContactResult result = friction_.evaluate(contact);

    const double sliding_x = contact.pinion_velocity_x - contact.gear_velocity_x;
    const double sliding_y = contact.pinion_velocity_y - contact.gear_velocity_y;
    const double sliding = result.sliding_speed;
    if (arms_ == FrictionArms::kTabulated) {
      instant->pinion_friction_torque +=
          interpolate(gear_pair_.pinion_friction_arm) * result.friction;
      instant->gear_friction_torque += interpolate(gear_pair_.gear_friction_arm) * result.friction;
    } else if (sliding > 0.0) {  // friction opposes the sliding
      const double pinion_arm = -(sliding_x * pinion_arm_x + sliding_y * pinion_arm_y) / sliding;
      const double gear_arm = (sliding_x * gear_arm_x + sliding_y * gear_arm_y) / sliding;
      instant->pinion_friction_torque += pinion_arm * result.friction;
      instant->gear_friction_torque += gear_arm * result.friction;
    }
    instant->friction_power += sliding * result.friction;
    instant->viscous_friction += result.viscous_friction;
    instant->boundary_friction += result.boundary_friction;
    instant->maximum_temperature = std::max(instant->maximum_temperature, result.temperature);
    instant->minimum_film_parameter =
        std::min(instant->minimum_film_parameter, result.film_parameter);
    instant->maximum_pressure = std::max(instant->maximum_pressure, result.maximum_pressure);
  }
}

ContactMode GearPairSystem::mode_of(const State& state) const {
  const Instant drive = evaluate(state, 0, ContactMode::kDriveUnloaded, 0.0, 0.0);
  if (drive.transmission_error >= gear_pair_.half_backlash) {
    return drive.mesh_force > 0.0 ? ContactMode::kDriveLoaded : ContactMode::kDriveUnloaded;
  }
  if (drive.transmission_error > -gear_pair_.half_backlash) return ContactMode::kSeparated;
  const Instant coast = evaluate(state, 0, ContactMode::kCoastUnloaded, 0.0, 0.0);
  return coast.mesh_force < 0.0 ? ContactMode::kCoastLoaded : ContactMode::kCoastUnloaded;
}

}  // namespace tribodyn::yardstick
